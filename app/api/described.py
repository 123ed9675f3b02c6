"""Additions to the description at /docs that FastAPI cannot read from signatures: bodies, problems, messages, links."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

from fastapi import FastAPI
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute
from pydantic import BaseModel

from app.api.body import JsonBody
from app.api.problems import MEDIA_TYPE

_INVALID, _OF_FASTAPI = "422", "HTTPValidationError"

_IDS = {"DocumentAnswer": "document_id", "PlanAnswer": "plan_id", "JobAnswer": "job_id"}
"""By the answer that has an `id`, the parameter of other paths that it is."""

_IN_BODIES = {"start_rehearsals": ("plan_id", "plan")}
"""By the operation, the parameter that it takes in its body, and the field."""

Operation = tuple[str, str, dict[str, Any]]
"""A method, a path, and what the description says of it."""

_PROBLEM = {"$ref": "#/components/schemas/Problem"}


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Return the descriptions of the errors that a route may answer with."""
    content = {MEDIA_TYPE: {"schema": _PROBLEM}}
    return {status: {"description": "A problem (RFC 9457)", "content": content} for status in statuses}


def answering(model: Any, *statuses: int, status: int = 200) -> dict[int | str, dict[str, Any]]:  # noqa: ANN401
    """Return the descriptions of a route's answer, and of the errors that it may answer with."""
    return {status: {"model": model}, **problems(*statuses)}


class DescribedRoute(APIRoute):
    """A route whose description includes the body that its dependency reads."""

    def __init__(self, *args: Any, **options: Any) -> None:  # noqa: ANN401
        """Add the body's schema and its example to the description."""
        super().__init__(*args, **options)
        for body in _bodies(self.dependant):
            self.openapi_extra = taking(body)


def _bodies(dependant: Dependant) -> Iterator[JsonBody[Any]]:
    """Yield the dependencies of a route that read its body, nested ones too."""
    for dependency in dependant.dependencies:
        if isinstance(dependency.call, JsonBody):
            yield dependency.call
        yield from _bodies(dependency)


def taking(body: JsonBody[Any]) -> dict[str, Any]:
    """Return the description of a request with this body."""
    content = {"application/json": {"schema": whole_schema(body.schema()), "example": body.example}}
    return {"requestBody": {"required": not body.may_be_empty, "content": content}}


def whole_schema(schema: dict[str, Any]) -> dict[str, Any]:
    """Return a schema that refers to nothing outside itself."""
    plain = dict(schema)
    definitions = plain.pop("$defs", {})
    whole: dict[str, Any] = _inlined(plain, definitions)
    return whole


def _inlined(schema: Any, definitions: dict[str, Any]) -> Any:  # noqa: ANN401
    """Return a schema with the model's own definitions put in place of references to them.

    Discriminators are left out: their mappings would still point at the definitions, and the variants tell themselves
    apart by their constants, which have to be given, though the types of the variants have them as defaults.
    """
    if isinstance(schema, list):
        return [_inlined(part, definitions) for part in schema]
    if not isinstance(schema, dict):
        return schema
    name = str(schema.get("$ref", "")).rpartition("/")[2]
    if name in definitions:
        return _inlined(definitions[name], definitions)
    whole = {key: _inlined(value, definitions) for key, value in schema.items() if key != "discriminator"}
    if "discriminator" in schema:
        whole["required"] = [schema["discriminator"]["propertyName"]]
    return whole


def describe(app: FastAPI, sent: type[BaseModel], *models: type[BaseModel]) -> None:
    """Add the schemas that no route's signature names, and links; say that all errors are problems.

    Problems, events and websocket messages are in no signature. FastAPI describes its own answer to parameters that are
    not valid, in place of which a problem is sent.

    Args:
        app: the server.
        sent: what pages send over the websocket.
        models: what is sent to them, and other answers.
    """
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        description = plain()
        schemas = description.setdefault("components", {}).setdefault("schemas", {})
        for model in models:
            schemas.update(_schemas(model))
        schemas[sent.__name__] = _without_defaults(whole_schema(sent.model_json_schema()))
        _tell_of_problems(description)
        _link(description)
        return description

    app.openapi = openapi  # type: ignore[method-assign]


def _tell_of_problems(description: dict[str, Any]) -> None:
    """Put problems in place of FastAPI's own description of parameters that are not valid."""
    for operations in description["paths"].values():
        for operation in operations.values():
            if _OF_FASTAPI in str(operation["responses"].get(_INVALID)):
                operation["responses"][_INVALID] = problems(int(_INVALID))[int(_INVALID)]
    for name in (_OF_FASTAPI, "ValidationError"):
        description["components"]["schemas"].pop(name, None)


def _schemas(model: type[BaseModel]) -> dict[str, Any]:
    schema = model.model_json_schema(ref_template="#/components/schemas/{model}", mode="serialization")
    definitions: dict[str, Any] = schema.pop("$defs", {})
    return {**definitions, model.__name__: schema}


def _without_defaults(schema: Any) -> Any:  # noqa: ANN401
    """Return a schema without defaults: the page's types would take a field that has one for required."""
    if isinstance(schema, list):
        return [_without_defaults(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    return {key: _without_defaults(value) for key, value in schema.items() if key != "default"}


def _link(description: dict[str, Any]) -> None:
    """Add links from the answers to calls that make something new to the calls that take its id.

    Who reads the description, a person or a program that tries all calls, so knows where an id comes from.
    """
    operations = list(_operations(description))
    for method, path, operation in operations:
        for status, response in operation["responses"].items():
            taken = _IDS.get(_model_of(response)) if method == "post" and status.startswith("2") else None
            if taken is not None and f"{{{taken}}}" not in path:
                response["links"] = dict(_links(taken, operations))


def _operations(description: Mapping[str, Any]) -> Iterator[Operation]:
    for path, methods in description["paths"].items():
        for method, operation in methods.items():
            yield method, path, operation


def _model_of(response: Mapping[str, Any]) -> str:
    """Return the name of the model that an answer in JSON has; empty if it has none."""
    schema = response.get("content", {}).get("application/json", {}).get("schema", {})
    return str(schema.get("$ref", "")).rpartition("/")[2]


def _links(parameter: str, operations: list[Operation]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield a link by its operation's id for each operation that takes a parameter."""
    for _, path, operation in operations:
        name, whole = operation["operationId"], "$response.body#/id"
        if f"{{{parameter}}}" in path:
            yield name, {"operationId": name, "parameters": {parameter: whole}}
        for begins, (taken, field) in _IN_BODIES.items():
            if taken == parameter and name.startswith(begins):
                yield name, {"operationId": name, "requestBody": {field: whole}}


def event_stream(kinds: Mapping[str, tuple[type[BaseModel], Mapping[str, Any]]], says: str) -> dict[str, Any]:
    """Return the description of an answer that is a stream of events.

    `itemSchema` describes one event, as OpenAPI 3.2 has it and as FastAPI does for 3.1; a schema of the whole stream
    would be one of a list. The models must be among those that `describe` adds. Tools that know of no `itemSchema`
    have the example, an event of each kind.

    Args:
        kinds: by an event's name, the model of its data and an example of it.
        says: what the stream tells, as a sentence.
    """
    item = {"required": ["event", "data"], "anyOf": [_event(name, model) for name, (model, _) in kinds.items()]}
    example = "".join(f"event: {name}\ndata: {json.dumps(data)}\n\n" for name, (_, data) in kinds.items())
    return {"description": says, "content": {"text/event-stream": {"itemSchema": item, "example": example}}}


def _event(name: str, model: type[BaseModel]) -> dict[str, Any]:
    data = {
        "type": "string",
        "contentMediaType": "application/json",
        "contentSchema": {"$ref": f"#/components/schemas/{model.__name__}"},
    }
    return {"title": name, "properties": {"event": {"const": name}, "data": data}}
