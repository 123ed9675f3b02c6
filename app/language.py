"""The words that the server shows to a person: those of the page's catalogues, in `static/words`.

The 3D view's panels and the instruction sheet speak the reader's language. REST, the command line and what is stored
stay English.
"""

import json
import re
from collections.abc import Mapping
from functools import cache
from typing import Literal, TypeAlias, get_args

from app.page_files import static_dir

Language: TypeAlias = Literal["en", "de", "es"]
LANGUAGES: tuple[Language, ...] = get_args(Language)
ENGLISH: Language = "en"

Text: TypeAlias = str | Mapping[str, str]
"""Words with places; where they depend on a number, a form for one and a form for others."""


def say(language: Language, key: str, **values: str | int) -> str:
    """Return the words of a key with values in its places; `count` chooses the form."""
    text = catalogue(language)[key]
    if not isinstance(text, str):
        text = text["one" if int(values["count"]) == 1 else "other"]
    return re.sub(r"\{(\w+)\}", lambda place: str(values[place[1]]), text)


def translated(language: Language, text: str) -> str:
    """Return a text that Pleat has given in English, as a shipped fold's name; any other text as it is."""
    key = _given().get(text)
    return text if key is None else say(language, key)


def numeral(language: Language, value: float, digits: int = 1) -> str:
    """Return a number with so many digits behind the language's decimal mark."""
    return f"{round(value, digits):.{digits}f}".replace(".", "." if language == ENGLISH else ",")


def named(language: Language, kind: str, name: str) -> str:
    """Return the words for one of a kind of things, as of a station; without any, its own name."""
    text = catalogue(language).get(f"{kind}.{name.replace(' ', '_')}")
    return text if isinstance(text, str) else name.replace("_", " ")


@cache
def catalogue(language: Language) -> Mapping[str, Text]:
    """Return all words of a language."""
    found: Mapping[str, Text] = json.loads((static_dir() / "words" / f"{language}.json").read_text(encoding="utf-8"))
    return found


@cache
def _given() -> Mapping[str, str]:
    """Return the keys of the names and labels that Pleat gives, by their English text."""
    texts = catalogue(ENGLISH).items()
    return {text: key for key, text in texts if isinstance(text, str) and key.startswith(("name.", "step.", "rule."))}
