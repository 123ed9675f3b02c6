"""Reads a garment file, strictly."""

from pydantic_core import from_json

from app.files.import_errors import broken
from planner.cloth.garment import Garment


def read_garment_json(data: bytes) -> Garment:
    """The garment in a garment file.

    Raises:
        ImportedFileError: it is no JSON object.
        GarmentError: it is no garment; names the field.
    """
    try:
        values = from_json(data.removeprefix(b"\xef\xbb\xbf"), allow_inf_nan=False)
    except ValueError as error:
        raise broken(f"it is not JSON: {error}") from None
    if not isinstance(values, dict):
        raise broken("it is not a JSON object")
    return Garment.from_dict(values)
