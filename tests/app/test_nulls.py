"""Null is accepted in a request exactly where its description says so, and elsewhere refused by the field's name."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute, iter_route_contexts

from app.api.body import JsonBody
from app.api.create_app import create_app
from app.api.described import whole_schema
from app.job_kinds.kinds import BY_JSON
from app.settings import Settings
from planner.errors import FieldError
from planner.strict_model import field_path
from tests.app.samples import towel

POSE = {"x_m": -0.9, "y_m": 0.0, "yaw_rad": 0.0}
FULLER = {
    "garment": towel(),
    "placement": POSE,
    "scene": {"stations": {"front": POSE}},
    "start": {"base": {}, "held": [{"arm": "left", "point": [0.0, 0.0]}]},
}
"""Fields with parts of their own, for bodies whose example has none or only a name there."""


def bodies_of(dependant: Dependant) -> Iterator[JsonBody[Any]]:
    """Yield what reads the bodies of a route."""
    for one in dependant.dependencies:
        if isinstance(one.call, JsonBody):
            yield one.call
        yield from bodies_of(one)


@pytest.fixture(scope="module")
def bodies(tmp_path_factory: pytest.TempPathFactory) -> list[JsonBody[Any]]:
    """Return what reads each body of the interface."""
    app = create_app(Settings(data=tmp_path_factory.mktemp("data") / Path("nowhere")))
    routes = [context.original_route for context in iter_route_contexts(app.routes)]
    of_routes = [body for route in routes if isinstance(route, APIRoute) for body in bodies_of(route.dependant)]
    assert len(of_routes) > 14
    return of_routes + [JsonBody(kind.body, kind.example) for kind in BY_JSON]


def variants(schema: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the schemas of which a value has to suit one."""
    found = schema.get("anyOf") or schema.get("oneOf")
    shared = {name: part for name, part in schema.items() if name not in ("anyOf", "oneOf")}
    return [schema] if found is None else [one for part in found for one in variants(both(shared, part))]


def both(schema: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of what suits two; of a field in both, the first says what it is by itself."""
    for part in other.get("allOf", ()):
        schema = both(schema, part)
    fields = {**other.get("properties", {}), **schema.get("properties", {})}
    return {**schema, **other, **({"properties": fields} if fields else {})}


def may_be_null(schema: dict[str, Any]) -> bool:
    """Whether a schema describes null."""
    return any(one.get("type", "null") == "null" and not {"const", "enum"} & set(one) for one in variants(schema))


def members(schema: dict[str, Any], value: Any) -> dict[str | int, dict[str, Any]]:
    """Return the schemas of what a value has, or could have, in it."""
    if isinstance(value, list):
        of_list = next((one for one in variants(schema) if one.get("type") == "array" and "items" in one), {})
        return dict.fromkeys(range(len(value)), of_list["items"]) if of_list else {}
    if not isinstance(value, dict):
        return {}
    for one in variants(schema):
        fields = one.get("properties", {})
        if one.get("type") == "object" and all(
            value.get(name) == field["const"] for name, field in fields.items() if "const" in field
        ):
            others = one.get("additionalProperties")
            return {**(dict.fromkeys(value, others) if isinstance(others, dict) else {}), **fields}
    return {}


def places(schema: dict[str, Any], value: Any, at: tuple[str | int, ...] = ()) -> Iterator[tuple[Any, bool]]:
    """Yield the path of each member of a value, those that it leaves out too, and whether null is described there."""
    for name, member in members(schema, value).items():
        yield (*at, name), may_be_null(member)
        is_there = isinstance(value, list) or name in value
        if is_there:
            yield from places(member, value[name], (*at, name))


def with_null(value: Any, path: tuple[str | int, ...]) -> Any:
    """Return JSON with null in one place."""
    here = changed = json.loads(json.dumps(value))
    for name in path[:-1]:
        here = here[name]
    here[path[-1]] = None
    return changed


def refusal(body: JsonBody[Any], value: Any) -> FieldError | None:
    """Return the error with which a body is refused, if it is."""
    try:
        body.form.read(value)
    except FieldError as error:
        return error
    return None


def test_null_is_read_where_the_description_says_so_and_else_refused_by_name(bodies: list[JsonBody[Any]]) -> None:
    seen = set()
    for body in bodies:
        schema = whole_schema(body.schema())
        fields = schema.get("properties", {})
        absent = [name for name in FULLER if name in fields and not isinstance(body.example.get(name), dict)]
        value = {**body.example, **{name: FULLER[name] for name in absent}}
        assert refusal(body, value) is None, value
        for path, is_described in places(schema, value):
            refused = refusal(body, with_null(value, path))
            assert (refused is None) == is_described, (path, refused)
            if refused is not None:
                assert refused.field == field_path(path), refused
            seen.add((path, is_described))
    assert {(("scene", "stations"), True), (("scene", "table"), True), (("scene", "stations", "front"), False)} <= seen
    assert {(("garment", "placement"), True), (("garment", "outline"), False), (("garment", "folds", 0), False)} <= seen


def test_every_default_that_is_described_suits_its_own_description(bodies: list[JsonBody[Any]]) -> None:
    kinds: dict[str | None, type | tuple[type, ...]] = {
        "object": dict,
        "array": list,
        "string": str,
        "number": (int, float),
        "boolean": bool,
        "null": type(None),
    }
    found = set()

    def look(schema: Any) -> None:
        if isinstance(schema, list):
            for part in schema:
                look(part)
        elif isinstance(schema, dict):
            if "default" in schema and "default" not in schema.get("properties", {}):
                allowed = [kinds.get(one.get("type"), object) for one in variants(schema)]
                assert any(isinstance(schema["default"], one) for one in allowed), schema
                found.add(schema.get("title"))
            for part in schema.values():
                look(part)

    for body in bodies:
        look(whole_schema(body.schema()))
    assert "Stations" in found
