"""The description of streams of server-sent events: the name of each kind of event, and what its data is."""

import json
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel

MEDIA_TYPE = "text/event-stream"


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
    return {"description": says, "content": {MEDIA_TYPE: {"itemSchema": item, "example": example}}}


def _event(name: str, model: type[BaseModel]) -> dict[str, Any]:
    data = {
        "type": "string",
        "contentMediaType": "application/json",
        "contentSchema": {"$ref": f"#/components/schemas/{model.__name__}"},
    }
    return {"title": name, "properties": {"event": {"const": name}, "data": data}}
