"""The server's settings, from the command line or from variables such as ``PLEAT_HOST`` and ``PLEAT_DATA``."""

import os
from pathlib import Path
from typing import Annotated, Any

from platformdirs import user_data_path
from pydantic import BaseModel, ConfigDict, Field, model_validator


class Settings(BaseModel):
    """The server's settings.

    Attributes:
        host: the address to listen on.
        origin: the origin at which a proxy serves the pages, as in ``https://example.org``, if it sends that as `Host`.
        root_path: the prefix below which a proxy serves the pages, as in ``/pleat``.
        insecure: whether to let other machines in without the token.
        token_file: a file with the token to ask for; None: beyond loopback one that is made at the first start.
        new_token: whether to make a new token, after which the old one does not hold.
        log_json: whether the log's lines are JSON objects.
        requests_per_s: how many requests another machine may send in the long run (1/s).
        open_documents: how many documents another machine may have open at once; one that nobody uses makes room.
        connections: how many websockets another machine may have open at once; a page has two.
        port: the port; 0 lets the system pick a free one, which replaces it before serving starts.
        data: the folder for everything that is kept.
        database: the URL of a PostgreSQL database; None: SQLite in the data folder.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    host: str = "127.0.0.1"
    origin: Annotated[str, Field(pattern=r"^https?://[^/?#@\s]+$")] | None = None
    root_path: Annotated[str, Field(pattern=r"^(/[A-Za-z0-9._~-]+)*$")] = ""
    insecure: bool = False
    token_file: Path | None = None
    new_token: bool = False
    log_json: bool = False
    requests_per_s: float = Field(default=100.0, gt=0.0)
    open_documents: int = Field(default=32, gt=0)
    connections: int = Field(default=128, gt=0)
    port: int = Field(default=8000, ge=0, le=65535)
    data: Path = Field(default_factory=lambda: user_data_path("pleat"))
    database: str | None = None

    @model_validator(mode="before")
    @classmethod
    def _or_of_the_environment(cls, given: dict[str, Any]) -> dict[str, Any]:
        """Take what is not given from the environment."""
        variables = {name: os.environ.get(f"PLEAT_{name.upper()}") for name in cls.model_fields}
        return {name: value for name, value in variables.items() if value is not None} | given
