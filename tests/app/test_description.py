"""The description of the interface has no dangling references."""

from collections.abc import Iterator

import httpx
import pytest
from pydantic import TypeAdapter

from app.api import job_answers, suggestion_routes
from planner.task.task import Limits
from tests.app.samples import towel
from tests.app.test_described_answers import assert_described
from tests.app.test_suggestion_routes import events_in

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


@pytest.mark.usefixtures("own_robot")
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
        for parameter in description["paths"][path][method].get("parameters", ()):
            for given in parameter["schema"].get("examples", ()):
                path = path.replace(f"{{{parameter['name']}}}", given)
        if "{document_id}" in path:
            document = (await client.post("/api/documents", json={"garment": towel()})).json()
            path = path.replace("{document_id}", document["id"])
        if path in ("/api/rehearsals", "/api/runs"):
            plan = (await client.post("/api/plans", json={"garment": "letter-towel"})).json()
            example = {**example, "plan": plan["id"]}
        answer = await client.request(method, path, json=example)
        assert answer.is_success, (method, path, answer.text)
        if answer.status_code == 202:
            await client.post(f"{answer.headers['location']}/cancel")


async def test_events_are_described_one_by_one_with_examples_that_are_such_events(client: httpx.AsyncClient) -> None:
    description = (await client.get("/openapi.json")).json()
    models = {model.__name__: model for model in (*suggestion_routes.EVENTS, *job_answers.EVENTS)}
    found = {}
    for path, operations in description["paths"].items():
        for operation in operations.values():
            stream = operation["responses"].get("200", {}).get("content", {}).get("text/event-stream")
            if stream is not None:
                assert set(stream) == {"itemSchema", "example"}, "a schema would be one of the whole stream"
                kinds = {kind["title"]: kind["properties"] for kind in stream["itemSchema"]["anyOf"]}
                found[path] = list(kinds)
                for name, data in events_in(stream["example"]):
                    assert kinds[name]["event"] == {"const": name}
                    model = kinds[name]["data"]["contentSchema"]["$ref"].rpartition("/")[2]
                    assert_described(data, models[model])
    assert found == {
        "/api/suggestions": ["trying", "suggestion", "done"],
        "/api/jobs/{job_id}/events": ["progress", "found", "end"],
    }


async def test_links_lead_from_what_is_made_to_every_call_that_takes_its_id(client: httpx.AsyncClient) -> None:
    description = (await client.get("/openapi.json")).json()
    operations = {
        operation["operationId"]: (path, operation)
        for path, methods in description["paths"].items()
        for operation in methods.values()
    }
    linked: dict[str, set[str]] = {}
    for path, operation in operations.values():
        for response in operation["responses"].values():
            for target in response.get("links", {}).values():
                to = operations[target["operationId"]][0]
                for name in target.get("parameters", ()):
                    assert f"{{{name}}}" in to
                linked.setdefault(path, set()).add(to)
    for name, made in (("document_id", "/api/documents"), ("plan_id", "/api/plans"), ("job_id", "/api/studies")):
        assert {path for path, _ in operations.values() if f"{{{name}}}" in path} <= linked[made]
    assert "/api/rehearsals" in linked["/api/plans"]


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
