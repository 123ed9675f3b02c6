"""The catalogues of the page's words: complete in every language, and used as they are meant."""

import re
from html.parser import HTMLParser

import pytest

from app.files.exports import EXPORTS
from app.job_kinds.kinds import KINDS
from app.templates.catalogue import TEMPLATES
from planner import load_garment
from planner.task.scene import DEFAULT_STATIONS
from tests.page.catalogues import CATALOGUES, ENGLISH, LANGUAGES, Text
from tests.page.scripts import STATIC, calls

GARMENTS = STATIC.parent / "garments"
SAYING = frozenset({"say", "inEnglish"})


def forms(text: Text) -> dict[str, str]:
    """Return the forms of a text by the kind of number; of one without forms only `other`."""
    return text if isinstance(text, dict) else {"other": text}


def places(text: str) -> set[str]:
    """Return the names of the places in a text."""
    return set(re.findall(r"\{(\w+)\}", text))


@pytest.mark.parametrize("code", LANGUAGES)
def test_every_language_has_words_for_the_same(code: str) -> None:
    assert set(CATALOGUES[code]) == set(ENGLISH)


@pytest.mark.parametrize("code", LANGUAGES)
def test_words_have_the_same_places_and_forms_in_every_language(code: str) -> None:
    for key, text in CATALOGUES[code].items():
        assert forms(text).keys() == forms(ENGLISH[key]).keys(), key
        wanted = (
            places(forms(ENGLISH[key])["other"]) | {"count"} if isinstance(text, dict) else places(str(ENGLISH[key]))
        )
        for form in forms(text).values():
            assert form.strip(), key
            assert places(form) <= wanted if isinstance(text, dict) else places(form) == wanted, key


@pytest.mark.parametrize("code", LANGUAGES)
def test_spaces_at_the_ends_are_those_of_the_english_words(code: str) -> None:
    for key, text in CATALOGUES[code].items():
        english = forms(ENGLISH[key])["other"]
        for form in forms(text).values():
            assert (form[:1] == " ", form[-1:] == " ") == (english[:1] == " ", english[-1:] == " "), key


def test_the_keys_are_in_order() -> None:
    for code in LANGUAGES:
        assert list(CATALOGUES[code]) == sorted(ENGLISH)


def test_calls_name_words_that_there_are_and_give_what_these_need() -> None:
    for call in calls(SAYING):
        named = [key for key in ENGLISH if re.fullmatch(call.key, key)]
        assert named, call
        if call.names is not None and ".*" not in call.key:
            wanted = {name for form in forms(ENGLISH[named[0]]).values() for name in places(form)}
            count = {"count"} if isinstance(ENGLISH[named[0]], dict) else set()
            assert call.names >= wanted | count, call


class Named(HTMLParser):
    """Gathers the keys that a page names."""

    def __init__(self) -> None:
        """Begin with none."""
        super().__init__()
        self.keys: list[str] = []

    def handle_starttag(self, _: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take the keys of an element."""
        self.keys += [value for name, value in attrs if name.startswith("data-say") and value]


def test_the_pages_elements_name_words_that_there_are() -> None:
    page = Named()
    page.feed((STATIC / "index.html").read_text(encoding="utf-8"))
    assert page.keys
    assert set(page.keys) <= set(ENGLISH)


def test_all_that_pleat_names_itself_has_words() -> None:
    given = {str(text) for key, text in ENGLISH.items() if re.match(r"(name|file|measure|template)\.", key)}
    garments = [load_garment(file) for file in GARMENTS.glob("*.json")]
    names = [garment.title for garment in garments]
    names += [fold.name for garment in garments for fold in garment.folds]
    names += [name for template in TEMPLATES for name in (template.title, template.text)]
    names += [name for template in TEMPLATES for measure in template.measures for name in (measure.label, measure.text)]
    names += [fold.name for template in TEMPLATES for fold in template.garment({}).folds]
    names += [name for export in EXPORTS for name in (export.title, export.text)]
    assert {name for name in names if re.sub(r" \d+$", "", name) not in given} == set()


def test_stations_and_kinds_of_jobs_have_words() -> None:
    assert {f"station.{name}" for name in DEFAULT_STATIONS} <= set(ENGLISH)
    assert {f"job_kind.{name}" for name in KINDS} <= set(ENGLISH)
