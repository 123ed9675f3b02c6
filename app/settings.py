"""How the server is set up: by the command line, or or by variables such as ``PLEAT_HOST`` and ``PLEAT_DATA``."""

from pathlib import Path
from typing import Annotated

from platformdirs import user_data_path
from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict


class Settings(BaseSettings):
    """The server's settings.

    Attributes:
        host: the address to listen on.
        origin: where a proxy shows the pages, as in ``https://example.org``, if it passes this name on as `Host`.
        root_path: the prefix below which a proxy shows them, as in ``/pleat``.
        insecure: whether to listen where other machines come in, though nobody is asked who they are.
        port: the port; 0 lets the system pick a free one, and is replaced by that before anything is served.
        data: the folder for one's own garments and documents.
    """

    model_config = SettingsConfigDict(env_prefix="PLEAT_", frozen=True)

    host: str = "127.0.0.1"
    origin: Annotated[str, Field(pattern=r"^https?://[^/?#@\s]+$")] | None = None
    root_path: Annotated[str, Field(pattern=r"^(/[A-Za-z0-9._~-]+)*$")] = ""
    insecure: bool = False
    port: int = Field(default=8000, ge=0, le=65535)
    data: Path = Field(default_factory=lambda: user_data_path("pleat"))
