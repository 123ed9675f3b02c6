import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner, Result

from app.cli import cli
from bench.table_photo import Photo
from planner import load_garment
from planner.geometry.region import Region


def see(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["see", *arguments])


@pytest.fixture
def shirt(shirt_photo: Photo, tmp_path: Path) -> str:
    path = tmp_path / "shirt.jpg"
    path.write_bytes(shirt_photo.jpeg)
    return str(path)


@pytest.fixture
def bare(tmp_path: Path) -> str:
    path = tmp_path / "bare.png"
    table = np.random.default_rng(1).normal(150.0, 2.0, (240, 320, 3)).astype(np.uint8)
    path.write_bytes(cv2.imencode(".png", table)[1].tobytes())
    return str(path)


def test_what_is_seen_is_printed_and_written_as_json(shirt: str, tmp_path: Path) -> None:
    target = tmp_path / "seen.json"
    result = see(shirt, "--scale", "a4", "--json", str(target))
    assert result.exit_code == 0, result.output
    assert "corners" in result.stdout and "the frame of the sheet" in result.stdout
    seen = json.loads(target.read_text())
    assert set(seen) == {"garment", "placement", "frame", "scale_from", "sure", "notes"}
    assert seen["sure"]["known"] and seen["garment"]["folds"] == []
    length_m = load_garment("t-shirt").pattern.length
    assert Region.polygon(seen["garment"]["outline"]).length == pytest.approx(length_m, rel=0.03)


def test_what_is_like_a_template_brings_its_folds(shirt: str) -> None:
    result = see(shirt, "--like", "t-shirt", "--json", "-")
    assert result.exit_code == 0, result.output
    seen = json.loads(result.stdout)
    assert len(seen["garment"]["folds"]) == 5
    assert seen["sure"]["share_within"] > 0.9


@pytest.mark.long
def test_a_garment_that_is_not_folded_is_seen_to_be_so(shirt: str) -> None:
    result = see(shirt, "--scale", "a4", "--state-of", "t-shirt", "--json", "-")
    assert result.exit_code == 0, result.output
    state = json.loads(result.stdout)
    assert state["known"] and state["folds_done"] == [] and state["last_fold"] is None


def test_nothing_to_be_told_is_status_3(bare: str) -> None:
    result = see(bare, "--scale", "0.5m")
    assert result.exit_code == 3
    assert "stands out from the table" in result.stderr


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ((), "--scale: nothing in the picture says how large"),
        (("--scale", "five"), "--scale: expected one of a4"),
        (("--scale", "0.5m", "--like", "sock"), "sock"),
        (("--scale", "0.5m", "--state-of", "sock"), "sock"),
        (("--like", "tie", "--state-of", "tie"), "cannot be given together"),
    ],
)
def test_bad_input_and_no_scale_are_status_2(bare: str, options: tuple[str, ...], says: str) -> None:
    result = see(bare, *options)
    assert result.exit_code == 2
    assert says in result.stderr


def test_a_picture_that_is_missing_or_none_is_status_2_and_named(tmp_path: Path) -> None:
    missing, text = tmp_path / "missing.jpg", tmp_path / "text.jpg"
    text.write_text("no picture")
    for path in (missing, text):
        result = see(str(path))
        assert result.exit_code == 2
        assert str(path) in result.stderr
