"""The description of the interface has no dangling references."""

from collections.abc import Iterator

import httpx
import pytest
from pydantic import TypeAdapter

from planner.task.task import Limits

pytestmark = pytest.mark.anyio


def references(part: object) -> Iterator[str]:
    """Yield all references in a description, or a part of it, discriminators' mappings included."""
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


async def test_every_example_of_a_body_is_answered(client: httpx.AsyncClient) -> None:
    description = (await client.get("/openapi.json")).json()
    bodies = [
        (method, path, operation["requestBody"]["content"]["application/json"]["example"])
        for path, operations in description["paths"].items()
        for method, operation in operations.items()
        if "example" in operation.get("requestBody", {}).get("content", {}).get("application/json", {})
    ]
    assert len(bodies) >= 14
    for method, path, example in bodies:
        if "{document_id}" in path:
            document = (await client.post("/api/documents", json={"garment": "hand-towel"})).json()
            path = path.replace("{document_id}", document["id"])
        if path == "/api/rehearsals":
            plan = (await client.post("/api/plans", json={"garment": "letter-towel"})).json()
            example = {**example, "plan": plan["id"]}
        name = "towel" if "templates" in path else example.get("name")
        answer = await client.request(method, path.replace("{name}", str(name)), json=example)
        assert answer.is_success, (method, path, answer.text)


async def test_every_body_in_json_is_described_with_its_fields_and_an_example(client: httpx.AsyncClient) -> None:
    description = (await client.get("/openapi.json")).json()
    plan = description["paths"]["/api/plans"]["post"]["requestBody"]["content"]["application/json"]["schema"]
    limits = TypeAdapter(Limits).json_schema()["properties"]
    described = {name: plan["properties"][name] for name in limits if name != "work_limit_s"}
    assert described == {name: field for name, field in limits.items() if name != "work_limit_s"}
    assert plan["required"] == ["garment"]
    assert plan["additionalProperties"] is False
    for path, operations in description["paths"].items():
        for method, operation in operations.items():
            content = operation.get("requestBody", {}).get("content", {})
            assert (
                "octet-stream" in str(content)
                or list(content) == ["application/zip"]
                or "vnd.pleat.plan" in str(content)
                or all("example" in kind for kind in content.values())
            ), (method, path)


async def test_every_error_is_described_as_a_problem(client: httpx.AsyncClient) -> None:
    description = (await client.get("/openapi.json")).json()
    kinds = {
        (method, path, status): set(told.get("content", {}))
        for path, operations in description["paths"].items()
        for method, operation in operations.items()
        for status, told in operation["responses"].items()
        if status >= "400"
    }
    assert len(kinds) > 100
    others = {of: found for of, found in kinds.items() if found != {"application/problem+json"}}
    assert not others
    assert "HTTPValidationError" not in description["components"]["schemas"]


async def test_the_list_of_documents_is_described_with_the_problem_of_a_bad_query(client: httpx.AsyncClient) -> None:
    refused = await client.get("/api/documents", params={"limit": 0})
    described = (await client.get("/openapi.json")).json()["paths"]["/api/documents"]["get"]["responses"]["422"]
    assert refused.status_code == 422
    assert refused.headers["content-type"] in described["content"]
