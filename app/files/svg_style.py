"""What SVG elements look like, as far as it matters: presentation attributes, style sheets, `style`, inheritance.

Of style sheets the selectors that drawing programs write are understood: a name, a class, an id, and these joined.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass

from app.files.import_errors import broken
from app.files.markup import Element

INHERITED = ("stroke", "color", "visibility")
"""The properties that are looked at and that pass on to what is within an element."""

_OWN = ("display",)
RULES_MAX = 300
"""A style sheet with more rules is refused: each is looked at for each element."""

_SIMPLE = re.compile(r"(?P<tag>[a-zA-Z][\w-]*|\*)?(?P<more>(?:[.#][\w-]+)*)")
_PART = re.compile(r"[.#][\w-]+")


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule of a style sheet.

    Attributes:
        tag: the name that an element must have; None: any.
        marks: the classes (with a dot) and ids (with a hash) that it must have.
        properties: what it then looks like.
    """

    tag: str | None
    marks: frozenset[str]
    properties: Mapping[str, str]

    @property
    def weight(self) -> tuple[int, int, int]:
        """The heavier rule wins: ids, classes, names."""
        ids = sum(mark.startswith("#") for mark in self.marks)
        return (ids, len(self.marks) - ids, int(self.tag is not None))

    def is_for(self, element: Element, marks: frozenset[str]) -> bool:
        """Whether it is about an element that has these classes and this id."""
        return self.tag in (None, element.tag) and self.marks <= marks


@dataclass(frozen=True, slots=True)
class StyleSheet:
    """All rules of a document, the lightest first."""

    rules: tuple[Rule, ...]

    @staticmethod
    def of(root: Element) -> "StyleSheet":
        """The rules in all elements `style` of a document; raises `ImportedFileError` if there are too many."""
        sheets = [element.text for element in root.walk() if element.tag == "style"]
        rules = [rule for sheet in sheets for rule in _rules(_without_comments(sheet))]
        if len(rules) > RULES_MAX:
            raise broken(f"there are more than {RULES_MAX} rules in its style sheets")
        return StyleSheet(tuple(sorted(rules, key=lambda rule: rule.weight)))

    def style(self, element: Element, outer: Mapping[str, str]) -> dict[str, str]:
        """What an element looks like within one that looks so."""
        found = {name: outer[name] for name in INHERITED if name in outer}
        found |= {name: element.attributes[name] for name in (*INHERITED, *_OWN) if name in element.attributes}
        marks = _marks(element)
        for rule in self.rules:
            if rule.is_for(element, marks):
                found |= rule.properties
        found |= declared(element.attributes.get("style", ""))
        return {name: outer.get(name, "") if value == "inherit" else value for name, value in found.items()}


def declared(text: str) -> dict[str, str]:
    """The properties in a list like ``stroke: #00f; stroke-width: 2``."""
    pairs = (part.partition(":") for part in text.split(";"))
    return {
        name.strip().lower(): value.replace("!important", "").strip().lower() for name, colon, value in pairs if colon
    }


def is_hidden(style: Mapping[str, str]) -> bool:
    """Whether an element is not displayed, nor anything within it."""
    return style.get("display") == "none"


def is_invisible(style: Mapping[str, str]) -> bool:
    """Whether an element is not seen; what is within it may be."""
    return style.get("visibility") in ("hidden", "collapse")


def _rules(sheet: str) -> list[Rule]:
    """The rules of a sheet; those in a block such as @media count like any other."""
    found = []
    for part in sheet.split("}"):
        before, _, body = part.rpartition("{")
        for selector in before.rpartition("{")[2].split(","):
            simple = _SIMPLE.fullmatch(selector.strip())
            if simple is not None and simple.group():
                tag = simple["tag"]
                marks = frozenset(_PART.findall(simple["more"]))
                found.append(Rule(None if tag == "*" else tag, marks, declared(body)))
    return found


def _without_comments(sheet: str) -> str:
    kept, at = [], 0
    while (start := sheet.find("/*", at)) >= 0:
        kept.append(sheet[at:start])
        end = sheet.find("*/", start + 2)
        at = end + 2 if end >= 0 else len(sheet)
    return " ".join([*kept, sheet[at:]])


def _marks(element: Element) -> frozenset[str]:
    classes = {f".{name}" for name in element.attributes.get("class", "").split()}
    return frozenset(classes | {f"#{element.attributes.get('id', '')}"})
