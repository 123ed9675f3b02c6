"""Strict reading of JSON bodies, with errors that say what is wrong.

FastAPI's own parser accepts NaN and Infinity, fails on deep nesting, and has no size limit; so every route with a
body uses this one.
"""

from typing import Any, Generic, TypeVar

from fastapi import Request
from fastapi.concurrency import run_in_threadpool
from pydantic import TypeAdapter
from pydantic_core import from_json

from app.api.problems import TooLargeError
from planner.cloth.garment_files import drawing_in
from planner.errors import RequestError
from planner.json_form import JsonForm

LARGEST_BODY = 1 << 20

SMALL_BODY = 1 << 13
"""Size up to which a body is read where it arrives (bytes): that takes less time than to wait for another thread."""

Body = TypeVar("Body")


class JsonBody(Generic[Body]):
    """A dependency that returns the value of a request's body, read strictly by its type.

    Attributes:
        may_be_empty: whether an empty body counts as an object without fields.
        example: a valid body, for the description.
        form: reads the body from JSON.
    """

    def __init__(self, kind: type[Body], example: dict[str, Any], *, may_be_empty: bool = False) -> None:
        """Read bodies of this type."""
        self.may_be_empty, self.example = may_be_empty, example
        self._kind: Any = kind
        self.form: JsonForm[Body] = JsonForm(kind)

    async def __call__(self, request: Request) -> Body:
        """Return the value; raises as `read_object` does, and the `FieldError` of the first wrong field."""
        body = await read_bytes(request, LARGEST_BODY)
        data = _object(request, body, may_be_empty=self.may_be_empty)
        return self.form.read(data) if len(body) <= SMALL_BODY else await run_in_threadpool(self.form.read, data)

    def schema(self) -> dict[str, Any]:
        """Return the JSON schema of the body."""
        return TypeAdapter(self._kind).json_schema()


async def read_object(request: Request, *, most: int) -> dict[str, Any]:
    """Return the body as a JSON object.

    Raises:
        TooLargeError: the body has more bytes than allowed.
        RequestError: the content type is not JSON, or the body is no JSON or no object.
    """
    return _object(request, await read_bytes(request, most))


def _object(request: Request, body: bytes, *, may_be_empty: bool = False) -> dict[str, Any]:
    if may_be_empty and not body:
        return {}
    _require_json_type(request.headers.get("content-type"))
    data = parsed(body)
    if not isinstance(data, dict):
        raise RequestError("body", "the body is not a JSON object")
    return data


def parsed(text: bytes | str) -> Any:  # noqa: ANN401
    """Parse strict JSON: UTF-8, no NaN, no Infinity, nesting below 200; raises `RequestError`."""
    try:
        return from_json(text, allow_inf_nan=False)
    except ValueError as error:
        said = drawing_in(text) if isinstance(text, bytes) else None
        raise RequestError("body", f"the body is not JSON: {said or error}") from None


def _require_json_type(content_type: str | None) -> None:
    if content_type is None:
        return
    kind = content_type.partition(";")[0].strip().lower()
    if kind != "application/json" and not (kind.startswith("application/") and kind.endswith("+json")):
        raise RequestError("body", f"the body is {kind[:80]!r}, it should be application/json")


async def read_bytes(request: Request, most: int) -> bytes:
    """Return the raw body; raises `TooLargeError` if it has more bytes than allowed."""
    declared = request.headers.get("content-length", "0")
    if declared.isascii() and declared.isdigit() and int(declared[:20]) > most:
        raise too_large(most)
    chunks, size = [], 0
    async for chunk in request.stream():
        size += len(chunk)
        if size > most:
            raise too_large(most)
        chunks.append(chunk)
    return b"".join(chunks)


def too_large(most: int) -> TooLargeError:
    """Return the error for a request of more bytes than allowed."""
    return TooLargeError(f"a request has at most {most} bytes ({most >> 20} MiB)")
