"""Reading of garment files, shipped ones and others."""

import codecs
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, TypeAlias

from planner.cloth.garment import NAME_PATTERN, Garment
from planner.errors import GarmentError, GarmentFileError, UnknownGarmentError

OtherKind: TypeAlias = Literal["pattern", "crease pattern", "plan", "robot"]
"""Kinds of JSON files that are no garment files."""

_SAID: dict[OtherKind, str] = {
    "pattern": "a pattern of GarmentCode",
    "crease pattern": "a crease pattern in the FOLD format",
    "plan": "a plan file",
    "robot": "the card of a robot",
}
_DRAWN = {
    r"\s*<(?:[?!][^<]*<)*(?:\w+:)?svg\b": "an SVG drawing",
    r"\s*(?:999\s[^\n]*\n\s*)*0\s+SECTION\s|AutoCAD Binary DXF": "a DXF drawing",
    r"\x89PNG": "a PNG picture",
    r"\xff\xd8\xff": "a JPEG picture",
}
_OPENED = "open it on the page or with POST /api/imports"
_HEAD = 2000
"""The number of bytes at the beginning of a file by which its kind is recognised."""


def shipped_folder() -> Path:
    """Return the folder of the shipped garments: beside the packages in a checkout, inside `planner` when installed."""
    package = Path(__file__).parents[1]
    installed = package / "garments"
    return installed if installed.is_dir() else package.parent / "garments"


def shipped_garment_names() -> list[str]:
    """Return the names of the shipped garments, in alphabetical order."""
    return sorted(path.stem for path in shipped_folder().glob("*.json"))


def load_garment(source: str | Path) -> Garment:
    """Return a shipped garment by name, or the garment in a file by path.

    Raises:
        UnknownGarmentError: a name (no dot, no slash) that is not shipped.
        GarmentFileError: a file that is missing or no JSON, or a source that is neither name nor path.
        GarmentError: a garment that is not valid; names the field.
    """
    if not isinstance(source, str | Path):
        raise GarmentFileError(f"{source!r:.80} is neither a garment's name nor a path")
    if isinstance(source, str) and NAME_PATTERN.fullmatch(source):
        if source in shipped_garment_names():
            return _read(shipped_folder() / f"{source}.json")
        if not Path(source).exists():
            raise UnknownGarmentError(source)
    return _read(Path(source))


def garment_in(values: Mapping[str, Any]) -> Garment:
    """Return the garment in the contents of a garment file.

    Raises:
        GarmentError: it is not valid, or another kind of file; names the field, or says which kind.
    """
    kind = other_kind(values)
    if kind is None:
        return Garment.from_dict(values)
    where = "import it as a zip, with POST /api/robots/imports" if kind == "robot" else _OPENED
    raise GarmentError("", f"expected a garment file; this is {_SAID[kind]}; {where}")


def other_kind(values: Mapping[str, Any]) -> OtherKind | None:
    """Return the kind of a JSON file that is known not to be a garment file; else None."""
    pattern = values.get("pattern")
    if isinstance(pattern, dict) and isinstance(pattern.get("panels"), dict):
        return "pattern"
    if "file_spec" in values or "vertices_coords" in values:
        return "crease pattern"
    if "pleat_plan" in values:
        return "plan"
    return "robot" if "pleat_robot" in values else None


def drawing_in(data: bytes) -> str | None:
    """Return which drawing or picture a file is that is no JSON, and where it can be opened; None for other files."""
    head = data.removeprefix(codecs.BOM_UTF8)[:_HEAD].decode("latin-1")
    said = next((said for begins, said in _DRAWN.items() if re.match(begins, head)), None)
    return None if said is None else f"it is {said}; {_OPENED}"


def read_json(path: Path) -> object:
    """Return the JSON in a file; raises `GarmentFileError` if the file is missing or not JSON."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise GarmentFileError(f"{path}: cannot be read: {error.strerror}") from None
    try:
        return json.loads(data.decode("utf-8-sig"), parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        raise GarmentFileError(f"{path}: is no JSON: {drawing_in(data) or error}") from None


def _refuse_constant(word: str) -> float:
    raise ValueError(f"{word} is no JSON number")


def _read(path: Path) -> Garment:
    data = read_json(path)
    if not isinstance(data, dict):
        raise GarmentError("", "a garment file holds one JSON object")
    return garment_in(data)
