"""A new kind of step or fold touches few files: all others find it in a registry and name none."""

import re
from functools import cache
from pathlib import Path
from typing import get_args

import pytest

from app.fold_looks import FOLD_LOOKS
from app.step_kinds import STEP_KINDS
from planner.cloth.fold_kinds import FOLD_KINDS, FoldName
from planner.primitives.primitive_set import PRIMITIVES
from tests.page.catalogues import ENGLISH

ROOT = Path(__file__).parent.parent

AT_MOST = 12
"""The files that may name one kind, its own modules and three catalogues included."""

SUFFIXES = {".py", ".js", ".css", ".json", ".html"}

DEFAULT = {"blue"}
"""The fold that is meant where nobody says otherwise: whoever makes a new fold names it."""


@cache
def sources() -> dict[str, str]:
    """Return the product's texts by their paths, without what only uses it: shipped garments and robots."""
    files = [file for room in ("planner", "app", "static") for file in (ROOT / room).rglob("*")]
    return {
        str(file.relative_to(ROOT)): file.read_text(encoding="utf-8")
        for file in files
        if file.suffix in SUFFIXES and "cards" not in file.parts
    }


def naming(kind: str) -> list[str]:
    """Return the files that name a kind: as a string, a key of a table, a style, or at the start or end of a key."""
    named = re.compile(rf"""["'`]{kind}["'`]|\.is-{kind}\b|^\s*{kind}: \{{|[_."]{kind}[".][\w.]*"?:""", re.MULTILINE)
    code = {path: re.sub(r"(?m)^\s*(#|\*|//).*$", "", text) for path, text in sources().items()}
    return sorted(path for path, text in code.items() if named.search(text))


@pytest.mark.parametrize("kind", sorted(set(FOLD_KINDS) - DEFAULT))
def test_a_kind_of_fold_is_named_in_few_files(kind: str) -> None:
    files = naming(kind)
    assert {"planner/cloth/fold_kinds.py", "app/fold_looks.py", "static/js/fold_kinds.js"} <= set(files)
    assert len(files) <= AT_MOST, files


def test_a_kind_of_step_is_named_in_few_files() -> None:
    files = naming("arm_drag")
    assert {"app/step_kinds.py", "static/js/dock/step_kinds.js"} <= set(files)
    assert len(files) <= AT_MOST, files


def test_all_tables_have_the_same_kinds() -> None:
    assert set(FOLD_KINDS) == set(get_args(FoldName)) == set(FOLD_LOOKS)
    assert {make.kind for make in PRIMITIVES} == set(STEP_KINDS)


def test_every_kind_has_words() -> None:
    for kind in FOLD_KINDS:
        assert {f"colour.{kind}", f"colour.{kind}.small", f"colour.{kind}.moves", f"step.make_{kind}"} <= set(ENGLISH)
    for kind in STEP_KINDS:
        assert {f"kind.{kind}", f"kind.{kind}.counted"} <= set(ENGLISH)
