"""The description of the interface: what reads it must find everything it refers to."""

from collections.abc import Iterator

import httpx
import pytest

pytestmark = pytest.mark.anyio


def references(part: object) -> Iterator[str]:
    """All places that a description, or a part of it, refers to, discriminators' mappings included."""
    if isinstance(part, list):
        for one in part:
            yield from references(one)
    elif isinstance(part, dict):
        if isinstance(part.get("$ref"), str):
            yield part["$ref"]
        if isinstance(part.get("discriminator"), dict):
            yield from part["discriminator"].get("mapping", {}).values()
        for one in part.values():
            yield from references(one)


async def test_whatever_the_description_refers_to_is_in_it(client: httpx.AsyncClient) -> None:
    description = (await client.get("/openapi.json")).json()
    found = set(references(description))
    assert found
    for reference in found:
        root, *path = reference.split("/")
        assert root == "#", reference
        here = description
        for name in path:
            assert name in here, reference
            here = here[name]
