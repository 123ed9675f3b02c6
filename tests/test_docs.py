"""The documents: links lead somewhere, and what they say is of today."""

import re
from pathlib import Path

import pytest

import planner

ROOT = Path(__file__).parent.parent
PAGES = [*sorted(ROOT.glob("docs/**/*.md")), ROOT / "README.md", ROOT / "CHANGELOG.md"]
GENERATED = [ROOT / "docs/reference" / name for name in ("cli.md", "rest.md")]
"""Pages that the site has alone: `make docs` makes them, and is strict about links."""

LINK = re.compile(r"\]\((?!https?:)([^)#]*)(?:#([^)]*))?\)")
HISTORY = re.compile(r"\b(since then|measured again|the version before)\b", re.IGNORECASE)


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings, named as on GitHub."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_to_files_and_headings(page: Path) -> None:
    for file, anchor in LINK.findall(page.read_text(encoding="utf-8")):
        target = page.parent / file if file else page
        assert target.exists() or target in GENERATED, file
        assert not anchor or anchor in anchors(target), f"{file}#{anchor}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_document_tells_no_history(page: Path) -> None:
    assert not HISTORY.findall(" ".join(page.read_text(encoding="utf-8").split()))


def test_every_name_that_the_planner_exports_is_in_the_reference() -> None:
    described = re.findall(r"^::: [\w.]*\.(\w+)$", (ROOT / "docs/reference/python.md").read_text(), re.MULTILINE)
    assert set(planner.__all__) <= set(described)


def test_the_files_that_the_architecture_names_are_there() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`((?:app|planner|static|tests)/[\w/*.]+)`", text))
    assert len(named) > 40
    assert [name for name in sorted(named) if not list(ROOT.glob(name))] == []


def test_the_modules_on_the_ways_through_the_program_are_there() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    ways = text.partition("## Two ways through the program")[2].partition("\n## ")[0]
    files = [f"/{file.with_suffix('')}" for folder in ("app", "static/js") for file in (ROOT / folder).rglob("*.*")]
    named = re.findall(r"(?<![/\w])[a-z_0-9]+(?:/[a-z_0-9]+)+", "\n".join(re.findall(r"^    .*$", ways, re.MULTILINE)))
    assert len(named) > 20
    assert [name for name in named if not any(file.endswith(f"/{name}") for file in files)] == []
