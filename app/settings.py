"""How the server is set up: by the command line, or by ``PLEAT_HOST``, ``PLEAT_PORT`` and ``PLEAT_DATA``."""

from pathlib import Path

from platformdirs import user_data_path
from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict


class Settings(BaseSettings):
    """The server's settings.

    Attributes:
        host: the address to listen on.
        port: the port; 0 lets the system pick a free one, and is replaced by that before anything is served.
        data: the folder for one's own garments and documents.
    """

    model_config = SettingsConfigDict(env_prefix="PLEAT_", frozen=True)

    host: str = "127.0.0.1"
    port: int = Field(default=8000, ge=0, le=65535)
    data: Path = Field(default_factory=lambda: user_data_path("pleat"))
