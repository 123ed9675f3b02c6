"""The catalogues of the page's words, by language."""

import json
from typing import TypeAlias

from tests.page.scripts import STATIC

Text: TypeAlias = str | dict[str, str]

LANGUAGES = ("en", "de", "es")
CATALOGUES: dict[str, dict[str, Text]] = {
    code: json.loads((STATIC / "words" / f"{code}.json").read_text(encoding="utf-8")) for code in LANGUAGES
}
ENGLISH = CATALOGUES["en"]
