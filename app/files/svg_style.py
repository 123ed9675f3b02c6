"""Resolves the style of SVG elements: presentation attributes, style sheets, `style` and inheritance."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from app.files.import_errors import broken
from app.files.markup import Element
from app.files.svg_selectors import Selector, read_selector

INHERITED = ("stroke", "fill", "stroke-width", "stroke-opacity", "fill-opacity", "color", "visibility")
"""The properties used here that an element passes on to its content."""

_OWN = ("display", "opacity", "clip-path")
RULES_MAX = 300
"""Largest number of style rules: every rule is matched against every element."""

_IMPORTANT = re.compile(r"!\s*important", re.IGNORECASE)

Properties: TypeAlias = dict[str, str]


@dataclass(frozen=True, slots=True)
class Declared:
    """Style properties.

    Attributes:
        plain: by name.
        important: those marked ``!important``, which win over all others.
    """

    plain: Properties
    important: Properties


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule of a style sheet: a selector, and the style properties that it sets."""

    selector: Selector
    declared: Declared


class StyleSheet:
    """All rules of a document, in order of increasing specificity."""

    def __init__(self, rules: Iterable[Rule]) -> None:
        self._rules = sorted(rules, key=lambda rule: rule.selector.weight)
        self._matched: dict[Element, tuple[Rule, ...]] = {}

    @staticmethod
    def of(root: Element) -> "StyleSheet":
        """Return the rules in all `style` elements of a document; raise `ImportedFileError` if there are too many."""
        sheets = [element.text for element in root.walk() if element.tag == "style"]
        rules = [rule for sheet in sheets for rule in _rules(_without_comments(sheet))]
        if len(rules) > RULES_MAX:
            raise broken(f"there are more than {RULES_MAX} rules in its style sheets")
        return StyleSheet(rules)

    def style(self, element: Element, outer: Mapping[str, str]) -> Properties:
        """Return the style of an element within an outer style."""
        found = {name: outer[name] for name in INHERITED if name in outer}
        found |= {name: element.attributes[name] for name in (*INHERITED, *_OWN) if name in element.attributes}
        rules, own = self._rules_for(element), declared(element.attributes.get("style", ""))
        for said in (*(rule.declared.plain for rule in rules), own.plain):
            found |= said
        for said in (*(rule.declared.important for rule in rules), own.important):
            found |= said
        return {name: outer.get(name, "") if value == "inherit" else value for name, value in found.items()}

    def _rules_for(self, element: Element) -> tuple[Rule, ...]:
        """Return the rules for an element; by where it stands, and not by where a reference draws it."""
        found = self._matched.get(element)
        if found is None:
            found = self._matched[element] = tuple(rule for rule in self._rules if rule.selector.is_for(element))
        return found


def declared(text: str) -> Declared:
    """Return the properties in a list such as ``stroke: #00f; stroke-width: 2``."""
    plain: Properties = {}
    important: Properties = {}
    for part in text.split(";"):
        name, colon, value = part.partition(":")
        if colon:
            bare, count = _IMPORTANT.subn("", value)
            (important if count else plain)[name.strip().lower()] = _value(bare)
    return Declared(plain, important)


def _value(text: str) -> str:
    """Return a value in small letters, but as it is if it refers to an id."""
    return text.strip() if "(#" in text or "('#" in text or '("#' in text else text.strip().lower()


def _rules(sheet: str) -> list[Rule]:
    """Return the rules of a sheet; treat rules in a block such as @media like any others."""
    found = []
    for part in sheet.split("}"):
        before, _, body = part.rpartition("{")
        for text in before.rpartition("{")[2].rpartition(";")[2].split(","):
            selector = read_selector(text)
            if selector is not None:
                found.append(Rule(selector, declared(body)))
    return found


def _without_comments(sheet: str) -> str:
    kept, at = [], 0
    sheet = sheet.replace("<!--", " ").replace("-->", " ")
    while (start := sheet.find("/*", at)) >= 0:
        kept.append(sheet[at:start])
        end = sheet.find("*/", start + 2)
        at = end + 2 if end >= 0 else len(sheet)
    return " ".join([*kept, sheet[at:]])
