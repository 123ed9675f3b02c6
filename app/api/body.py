"""Reads JSON bodies strictly, and says what is wrong with one that is no JSON.

FastAPI would read them itself, but with a parser that takes NaN and Infinity, stumbles over deep nesting, and
has no limit; so the routes that take a body come here.
"""

from typing import Any, TypeVar

from fastapi import Request
from pydantic import ValidationError
from pydantic_core import from_json

from app.api.problems import TooLargeError
from planner.errors import RequestError
from planner.strict_model import StrictModel, first_error

LARGEST_BODY = 1 << 20

Model = TypeVar("Model", bound=StrictModel)


async def read_model(request: Request, model: type[Model], *, may_be_empty: bool = False) -> Model:
    """The body as a model; raises what `read_object` does, and `RequestError` with the first wrong field.

    A body that may be empty and is counts as an object without fields.
    """
    data = await read_object(request, may_be_empty=may_be_empty)
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise first_error(error, RequestError) from None


async def read_object(request: Request, *, may_be_empty: bool = False, most: int = LARGEST_BODY) -> dict[str, Any]:
    """The body as a JSON object.

    Raises:
        TooLargeError: it has more than so many bytes, by default `LARGEST_BODY`.
        RequestError: it is not called JSON, is no JSON, or no object.
    """
    body = await read_bytes(request, most)
    if may_be_empty and not body:
        return {}
    _require_json_type(request.headers.get("content-type"))
    data = parsed(body)
    if not isinstance(data, dict):
        raise RequestError("body", "the body is not a JSON object")
    return data


def parsed(text: bytes | str) -> Any:  # noqa: ANN401
    """JSON, strictly: UTF-8, no NaN, no Infinity, nesting below 200; raises `RequestError`."""
    try:
        return from_json(text, allow_inf_nan=False)
    except ValueError as error:
        raise RequestError("body", f"the body is not JSON: {error}") from None


def _require_json_type(content_type: str | None) -> None:
    if content_type is None:
        return
    kind = content_type.partition(";")[0].strip().lower()
    if kind != "application/json" and not (kind.startswith("application/") and kind.endswith("+json")):
        raise RequestError("body", f"the body is {kind[:80]!r}, it should be application/json")


async def read_bytes(request: Request, most: int) -> bytes:
    """The body as it is; raises `TooLargeError` if it has more bytes than that."""
    declared = request.headers.get("content-length", "0")
    if declared.isascii() and declared.isdigit() and int(declared[:20]) > most:
        raise _too_large(most)
    chunks, size = [], 0
    async for chunk in request.stream():
        size += len(chunk)
        if size > most:
            raise _too_large(most)
        chunks.append(chunk)
    return b"".join(chunks)


def _too_large(most: int) -> TooLargeError:
    return TooLargeError(f"a request has at most {most} bytes ({most >> 20} MiB)")
