"""Reading of garment files, shipped ones and others."""

import json
from pathlib import Path

from planner.cloth.garment import NAME_PATTERN, Garment
from planner.errors import GarmentError, GarmentFileError, UnknownGarmentError


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


def read_json(path: Path) -> object:
    """Return the JSON in a file; raises `GarmentFileError` if the file is missing or not JSON."""
    try:
        return json.loads(path.read_text(encoding="utf-8"), parse_constant=_refuse_constant)
    except OSError as error:
        raise GarmentFileError(f"{path}: cannot be read: {error.strerror}") from None
    except (UnicodeDecodeError, ValueError, RecursionError) as error:
        raise GarmentFileError(f"{path}: is no JSON: {error}") from None


def _refuse_constant(word: str) -> float:
    raise ValueError(f"{word} is no JSON number")


def _read(path: Path) -> Garment:
    data = read_json(path)
    if not isinstance(data, dict):
        raise GarmentError("", "a garment file holds one JSON object")
    return Garment.from_dict(data)
