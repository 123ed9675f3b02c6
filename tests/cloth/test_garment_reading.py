"""Garments by name or path; unreadable ones are refused with the cause."""

import json
from pathlib import Path

import pytest

from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.errors import FoldingError, GarmentError, GarmentFileError, UnknownGarmentError

TOWEL = {"name": "towel", "outline": [[0, 0], [0.4, 0], [0.4, 0.3]]}


def written(folder: Path, text: str) -> Path:
    path = folder / "towel.json"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_shipped_garment_is_found_by_its_name() -> None:
    assert load_garment("t-shirt").title == "T-shirt"
    assert {"t-shirt", "jeans", "tie"} <= set(shipped_garment_names())
    assert shipped_garment_names() == sorted(shipped_garment_names())


def test_a_garment_is_read_from_a_path_given_as_either_type(tmp_path: Path) -> None:
    path = written(tmp_path, json.dumps(TOWEL))
    assert load_garment(path) == load_garment(str(path))


def test_an_unknown_name_is_said() -> None:
    with pytest.raises(UnknownGarmentError, match="'sock'"):
        load_garment("sock")


def test_a_missing_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(GarmentFileError, match="cannot be read"):
        load_garment(tmp_path / "nothing.json")


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(GarmentFileError, match="cannot be read"):
        load_garment(tmp_path)


def test_a_source_that_is_neither_name_nor_path_is_said() -> None:
    with pytest.raises(GarmentFileError, match="3 is neither a garment's name nor a path"):
        load_garment(3)  # type: ignore[arg-type]


@pytest.mark.parametrize("text", ["", "{", '{"name": NaN}', "[1, 2", "\u00e9", '{"a": Infinity}', "[" * 100_000])
def test_what_is_no_json_is_said(tmp_path: Path, text: str) -> None:
    with pytest.raises(GarmentFileError, match="is no JSON"):
        load_garment(written(tmp_path, text))


def test_bytes_that_are_no_text_are_no_json(tmp_path: Path) -> None:
    path = tmp_path / "towel.json"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(GarmentFileError, match="is no JSON"):
        load_garment(path)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b'{"pattern": {"panels": {"front": {}}}, "properties": {}}', "GarmentCode.*POST /api/imports"),
        (b'\xef\xbb\xbf{"file_spec": 1.1, "vertices_coords": []}', "FOLD.*POST /api/imports"),
        (b'{"pleat_plan": 1}', "plan file.*POST /api/imports"),
        (b'{"pleat_robot": 1, "name": "bench"}', "card of a robot.*POST /api/robots/imports"),
        (b"<svg/>", "SVG.*POST /api/imports"),
        (b'<?xml version="1.0"?>\n<!-- by hand -->\n<!DOCTYPE svg [<!ENTITY a "b">]>\n<svg width="3"/>', "SVG"),
        (b"999\nby hand\n  0\r\nSECTION\r\n", "DXF.*POST /api/imports"),
        (b"AutoCAD Binary DXF\r\n\x1a\0", "DXF"),
        (b"\x89PNG\r\n\x1a\n", "PNG"),
        (b"\xff\xd8\xff\xe0", "JPEG"),
    ],
)
def test_a_file_of_another_kind_is_named_with_where_it_can_be_opened(tmp_path: Path, content: bytes, said: str) -> None:
    path = tmp_path / "towel.json"
    path.write_bytes(content)
    with pytest.raises(FoldingError, match=said):
        load_garment(path)


@pytest.mark.parametrize("text", ["[]", "3", '"towel"', "null"])
def test_json_that_is_no_object_is_no_garment(tmp_path: Path, text: str) -> None:
    with pytest.raises(GarmentError, match="one JSON object"):
        load_garment(written(tmp_path, text))


@pytest.mark.parametrize("value", ["[" * 300 + "]" * 300, '"\\ud800"'])
def test_json_that_no_garment_can_hold_is_refused(tmp_path: Path, value: str) -> None:
    with pytest.raises(GarmentError):
        load_garment(written(tmp_path, json.dumps(TOWEL).replace('"towel"', value, 1)))
