"""Selectors of style sheets in SVG: names, classes, ids and attributes, within one another.

Of the combinators it knows those that drawing programs write, descendant (a space) and child (``>``). Steps are matched
from right to left with the set of elements that the rest may be matched at, so no selector takes exponentially long.
"""

import re
from dataclasses import dataclass
from typing import Literal, TypeAlias

from app.files.markup import Element

COMPOUNDS_MAX = 12
"""Largest number of steps of a selector; longer ones are ignored."""

_Combinator: TypeAlias = Literal[" ", ">"]
_Attribute: TypeAlias = tuple[str, str, str]

_TEST = r"""\[\s*(?:[\w-]*[:|])?([\w-]+)\s*(?:([~|^$*]?=)\s*(?:"([^"\]]*)"|'([^'\]]*)'|([\w-]+))\s*)?\]"""
_COMPOUND = re.compile(r"(?P<tag>(?:[\w-]*\|)?[a-zA-Z][\w-]*|\*)?(?P<more>(?:[.#][\w-]+|:root|\[[^\[\]]*\])*)")
_MARK = re.compile(r"[.#][\w-]+|:root")
_ATTRIBUTE = re.compile(_TEST)
_STEP = re.compile(r"\s*>\s*|\s+")


@dataclass(frozen=True, slots=True)
class Compound:
    """What one step of a selector asks of an element.

    Attributes:
        tag: the element name that it requires; None for any.
        marks: the classes (with a dot), ids (with a hash) and ``:root`` that it requires.
        attributes: the attributes that it requires: name, operator (empty: it is there) and value.
    """

    tag: str | None
    marks: frozenset[str]
    attributes: tuple[_Attribute, ...]

    def is_for(self, element: Element, marks: frozenset[str]) -> bool:
        """Return whether an element with these marks (see `marks_of`) is asked for."""
        return (
            self.tag in (None, element.tag)
            and self.marks <= marks
            and all(_has(element.attributes.get(name), operator, value) for name, operator, value in self.attributes)
        )


@dataclass(frozen=True, slots=True)
class Selector:
    """A selector.

    Attributes:
        last: its last step: what it asks of the element itself.
        outer: the steps before it from right to left, each with the combinator that follows it.
    """

    last: Compound
    outer: tuple[tuple[_Combinator, Compound], ...] = ()

    @property
    def weight(self) -> tuple[int, int, int]:
        """The specificity: numbers of ids, of classes and attributes, and of names; the larger wins."""
        steps = (self.last, *(step for _, step in self.outer))
        ids = sum(mark.startswith("#") for step in steps for mark in step.marks)
        others = sum(len(step.marks) + len(step.attributes) for step in steps) - ids
        return (ids, others, sum(step.tag is not None for step in steps))

    def is_for(self, element: Element) -> bool:
        """Return whether the selector is for an element."""
        if not self.last.is_for(element, marks_of(element)):
            return False
        places = {element}
        for combinator, step in self.outer:
            around = {outer for place in places for outer in _around(place, combinator)}
            places = {outer for outer in around if step.is_for(outer, marks_of(outer))}
            if not places:
                return False
        return True


def read_selector(text: str) -> Selector | None:
    """Return a selector; None for one that is not known."""
    parts = _STEP.split(text.strip())
    combinators = [">" if ">" in gap else " " for gap in _STEP.findall(text.strip())]
    if not 0 < len(parts) <= COMPOUNDS_MAX:
        return None
    steps = [_compound(part) for part in parts]
    known = [step for step in steps if step is not None]
    if len(known) < len(steps):
        return None
    outer: list[tuple[_Combinator, Compound]] = []
    for gap, step in zip(reversed(combinators), reversed(known[:-1]), strict=True):
        outer.append((">" if gap == ">" else " ", step))
    return Selector(known[-1], tuple(outer))


def marks_of(element: Element) -> frozenset[str]:
    """Return an element's classes, each with a dot, its id, with a hash, and ``:root`` for the root."""
    marks = {f".{name}" for name in element.attributes.get("class", "").split()}
    marks.add(f"#{element.attributes.get('id', '')}")
    if element.parent is None:
        marks.add(":root")
    return frozenset(marks)


def _compound(text: str) -> Compound | None:
    found = _COMPOUND.fullmatch(text)
    if found is None or not found.group():
        return None
    tests = re.findall(r"\[[^\[\]]*\]", found["more"])
    attributes = [_ATTRIBUTE.fullmatch(test) for test in tests]
    known = [(a[1], a[2] or "", a[3] or a[4] or a[5] or "") for a in attributes if a is not None]
    if len(known) < len(tests):
        return None
    marks = frozenset(_MARK.findall(re.sub(r"\[[^\[\]]*\]", "", found["more"])))
    tag = (found["tag"] or "*").rpartition("|")[2]
    return Compound(None if tag == "*" else tag, marks, tuple(known))


def _around(element: Element, combinator: _Combinator) -> list[Element]:
    outer = [] if element.parent is None else [element.parent]
    while combinator == " " and outer and outer[-1].parent is not None:
        outer.append(outer[-1].parent)
    return outer


def _has(value: str | None, operator: str, wanted: str) -> bool:
    if value is None or not operator:
        return value is not None
    if operator == "=":
        return value == wanted
    if operator == "~=":
        return wanted in value.split()
    if operator == "|=":
        return value == wanted or value.startswith(f"{wanted}-")
    if not wanted:
        return False
    return {"^=": value.startswith(wanted), "$=": value.endswith(wanted), "*=": wanted in value}[operator]
