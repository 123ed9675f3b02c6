"""Resolves the style of SVG elements: presentation attributes, style sheets, `style` and inheritance.

Of style sheets it understands the selectors that drawing programs write: a name, a class, an id, and combinations.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass

from app.files.import_errors import broken
from app.files.markup import Element

INHERITED = ("stroke", "color", "visibility")
"""The properties used here that an element passes on to its content."""

_OWN = ("display",)
RULES_MAX = 300
"""Largest number of style rules: every rule is matched against every element."""

_SIMPLE = re.compile(r"(?P<tag>[a-zA-Z][\w-]*|\*)?(?P<more>(?:[.#][\w-]+)*)")
_PART = re.compile(r"[.#][\w-]+")


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule of a style sheet.

    Attributes:
        tag: the element name that it requires; None for any.
        marks: the classes (with a dot) and ids (with a hash) that it requires.
        properties: the style properties that it sets.
    """

    tag: str | None
    marks: frozenset[str]
    properties: Mapping[str, str]

    @property
    def weight(self) -> tuple[int, int, int]:
        """The specificity: numbers of ids, classes and names; the larger wins."""
        ids = sum(mark.startswith("#") for mark in self.marks)
        return (ids, len(self.marks) - ids, int(self.tag is not None))

    def is_for(self, element: Element, marks: frozenset[str]) -> bool:
        """Return whether the rule applies to an element with these classes and id."""
        return self.tag in (None, element.tag) and self.marks <= marks


@dataclass(frozen=True, slots=True)
class StyleSheet:
    """All rules of a document, in order of increasing specificity."""

    rules: tuple[Rule, ...]

    @staticmethod
    def of(root: Element) -> "StyleSheet":
        """Return the rules in all `style` elements of a document; raise `ImportedFileError` if there are too many."""
        sheets = [element.text for element in root.walk() if element.tag == "style"]
        rules = [rule for sheet in sheets for rule in _rules(_without_comments(sheet))]
        if len(rules) > RULES_MAX:
            raise broken(f"there are more than {RULES_MAX} rules in its style sheets")
        return StyleSheet(tuple(sorted(rules, key=lambda rule: rule.weight)))

    def style(self, element: Element, outer: Mapping[str, str]) -> dict[str, str]:
        """Return the style of an element within an outer style."""
        found = {name: outer[name] for name in INHERITED if name in outer}
        found |= {name: element.attributes[name] for name in (*INHERITED, *_OWN) if name in element.attributes}
        marks = _marks(element)
        for rule in self.rules:
            if rule.is_for(element, marks):
                found |= rule.properties
        found |= declared(element.attributes.get("style", ""))
        return {name: outer.get(name, "") if value == "inherit" else value for name, value in found.items()}


def declared(text: str) -> dict[str, str]:
    """Return the properties in a list such as ``stroke: #00f; stroke-width: 2``."""
    pairs = (part.partition(":") for part in text.split(";"))
    return {
        name.strip().lower(): value.replace("!important", "").strip().lower() for name, colon, value in pairs if colon
    }


def is_hidden(style: Mapping[str, str]) -> bool:
    """Return whether an element and its content are not displayed."""
    return style.get("display") == "none"


def is_invisible(style: Mapping[str, str]) -> bool:
    """Return whether an element is invisible; its content may be visible."""
    return style.get("visibility") in ("hidden", "collapse")


def _rules(sheet: str) -> list[Rule]:
    """Return the rules of a sheet; treat rules in a block such as @media like any others."""
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
