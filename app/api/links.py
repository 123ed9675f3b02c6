"""Links in the description at /docs: which answers have the id that other calls ask for.

Who reads the description, a person or a program that tries all calls, so knows where an id comes from.
"""

from collections.abc import Iterator, Mapping
from typing import Any

_IDS = {"DocumentAnswer": "document_id", "PlanAnswer": "plan_id", "JobAnswer": "job_id"}
"""By the answer that has an `id`, the parameter of other paths that it is."""

_IN_BODIES = {"start_rehearsals": ("plan_id", "plan")}
"""By the operation, the parameter that it takes in its body, and the field."""

Operation = tuple[str, str, dict[str, Any]]
"""A method, a path, and what the description says of it."""


def link(description: dict[str, Any]) -> None:
    """Add links from the answers to calls that make something new to the calls that take its id."""
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
