"""Write the description of the interface to a file that the page's types are made of: ``python -m ... FILE``."""

import json
import sys
from pathlib import Path

from app.api.create_app import create_app
from app.settings import Settings


def main() -> None:
    """Write the description; no data folder is opened."""
    description = create_app(Settings(data=Path("nowhere"))).openapi()
    Path(sys.argv[1]).write_text(json.dumps(description), encoding="utf-8")


if __name__ == "__main__":
    main()
