"""What /docs says about the routes, where FastAPI cannot read it from a signature."""

from typing import Any

from fastapi import FastAPI
from pydantic import BaseModel

from app.api.problems import MEDIA_TYPE

_PROBLEM = {"$ref": "#/components/schemas/Problem"}


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The errors that a route may answer with."""
    content = {MEDIA_TYPE: {"schema": _PROBLEM}}
    return {status: {"description": "A problem (RFC 9457)", "content": content} for status in statuses}


def takes(model: type[BaseModel], *, may_be_empty: bool = False) -> dict[str, Any]:
    """Describe a route's body, as an entry of its OpenAPI description."""
    content = {"application/json": {"schema": whole_schema(model)}}
    return {"requestBody": {"required": not may_be_empty, "content": content}}


def whole_schema(model: type[BaseModel]) -> dict[str, Any]:
    """A model's schema that refers to nothing outside itself."""
    schema = model.model_json_schema()
    definitions = schema.pop("$defs", {})
    whole: dict[str, Any] = _inlined(schema, definitions)
    return whole


def _inlined(schema: Any, definitions: dict[str, Any]) -> Any:  # noqa: ANN401
    """A schema in which the model's own definitions stand where they are referred to.

    Discriminators are left out: their mappings would still point at the definitions, and the variants tell themselves
    apart by their constants.
    """
    if isinstance(schema, list):
        return [_inlined(part, definitions) for part in schema]
    if not isinstance(schema, dict):
        return schema
    name = str(schema.get("$ref", "")).rpartition("/")[2]
    if name in definitions:
        return _inlined(definitions[name], definitions)
    return {key: _inlined(value, definitions) for key, value in schema.items() if key != "discriminator"}


def describe(app: FastAPI, *models: type[BaseModel]) -> None:
    """Put the shapes of what no route's signature names into the description: problems, what the websocket carries."""
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        description = plain()
        schemas = description.setdefault("components", {}).setdefault("schemas", {})
        for model in models:
            schemas.update(_schemas(model))
        return description

    app.openapi = openapi  # type: ignore[method-assign]


def _schemas(model: type[BaseModel]) -> dict[str, Any]:
    schema = model.model_json_schema(ref_template="#/components/schemas/{model}")
    definitions: dict[str, Any] = schema.pop("$defs", {})
    return {**definitions, model.__name__: schema}
