"""Resolves the style of SVG elements: presentation attributes, style sheets, `style` and inheritance.

Selectors ask for names, classes, ids and attributes, within one another. Of the combinators those that drawing programs
write are known, descendant (a space) and child (``>``). Steps are matched from right to left with the set of elements
that the rest may be matched at, so no selector takes exponentially long.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Literal, TypeAlias

from app.files.import_errors import broken
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


INHERITED = ("stroke", "fill", "stroke-width", "stroke-opacity", "fill-opacity", "color", "visibility")
"""The properties used here that an element passes on to its content."""

_OWN = ("display", "opacity", "clip-path", "mask")
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

    def __init__(self, rules: Iterable[Rule], variables: Collection[str] = ()) -> None:
        self._rules = sorted(rules, key=lambda rule: rule.selector.weight)
        self._variables = variables
        self._matched: dict[Element, tuple[Rule, ...]] = {}
        self._in_place: dict[Element, Properties] = {}

    @staticmethod
    def of(root: Element) -> "StyleSheet":
        """Return the rules in all `style` elements of a document.

        Raises:
            ImportedFileError: there are too many, or too many variables in the document.
        """
        sheets = [element.text for element in root.walk() if element.tag == "style"]
        rules = [rule for sheet in sheets for rule in _rules(_without_comments(sheet))]
        if len(rules) > RULES_MAX:
            raise broken(f"there are more than {RULES_MAX} rules in its style sheets")
        values = (value for element in root.walk() for value in element.attributes.values())
        variables = {name for text in chain(sheets, values) for name in variables_in(text)}
        if len(variables) > VARIABLES_MAX:
            raise broken(f"there are more than {VARIABLES_MAX} variables in its styles")
        return StyleSheet(rules, variables)

    def style(self, element: Element, outer: Mapping[str, str]) -> Properties:
        """Return the style of an element within an outer style."""
        found = {name: outer[name] for name in (*INHERITED, *self._variables) if name in outer}
        found |= {name: element.attributes[name] for name in (*INHERITED, *_OWN) if name in element.attributes}
        rules, own = self._rules_for(element), declared(element.attributes.get("style", ""))
        for said in (*(rule.declared.plain for rule in rules), own.plain):
            found |= said
        for said in (*(rule.declared.important for rule in rules), own.important):
            found |= said
        found = {name: outer.get(name, "") if value == "inherit" else value for name, value in found.items()}
        if self._variables:
            found = self._with_variables(found, outer)
        return found

    def style_in_place(self, element: Element) -> Properties:
        """Return the style of an element within the elements around it in the document."""
        found = self._in_place.get(element)
        if found is None:
            outer = {} if element.parent is None else self.style_in_place(element.parent)
            found = self._in_place[element] = self.style(element, outer)
        return found

    def _with_variables(self, found: Properties, outer: Mapping[str, str]) -> Properties:
        """Return properties with the values of variables put in; one whose variable has no value is as if not said."""
        variables = _Variables({name: found[name] for name in self._variables if name in found})
        known: Properties = {}
        for name, value in found.items():
            replaced = variables.value(name) if name.startswith("--") else variables.put_into(value)
            if replaced is not None:
                known[name] = _value(replaced)
            elif name in INHERITED and name in outer:
                known[name] = outer[name]
        return known

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
            known = name.strip() if name.strip().startswith("--") else name.strip().lower()
            (important if count else plain)[known] = _value(bare)
    return Declared(plain, important)


def _value(text: str) -> str:
    """Return a value in small letters, but as it is if it refers to an id or a variable: their case matters."""
    is_named = "(#" in text or "('#" in text or '("#' in text or "--" in text
    return text.strip() if is_named else text.strip().lower()


VARIABLES_MAX = 200
"""Largest number of variables (custom properties) that a document uses: each is passed on to every element."""

_VALUE_LONGEST, _VARIABLES_DEEP = 1_000, 30
"""Longest value that variables are put into (characters), and how many of them may stand in one another."""

_VARIABLE = re.compile(r"var\(\s*(--[^\s,()]+)\s*", re.IGNORECASE)


def variables_in(text: str) -> list[str]:
    """Return the names of the variables that a text uses, as in ``var(--name, blue)``."""
    return _VARIABLE.findall(text) if "--" in text else []


class _Variables:
    """The variables of an element. Each is resolved once, so values that use many others take no longer.

    Args:
        values: the values by name; they may use variables in turn.
    """

    def __init__(self, values: Mapping[str, str]) -> None:
        self._values = values
        self._known: dict[str, str | None] = {}

    def value(self, name: str, deep: int = 0) -> str | None:
        """Return the value of a variable; None if it has none, or uses itself."""
        if name not in self._known:
            self._known[name] = None  # until it is resolved, for those that use themselves
            text = self._values.get(name, "initial")
            self._known[name] = None if text.lower() == "initial" else self.put_into(text, deep + 1)
        return self._known[name]

    def put_into(self, text: str, deep: int = 0) -> str | None:
        """Return a value with variables replaced by their values, or else by what stands after the comma.

        None if a variable has neither, or if the value gets too long.
        """
        whole, at = "", 0
        while (found := _VARIABLE.search(text, at)) is not None:
            end = _closing(text, found.end()) if len(text) <= _VALUE_LONGEST and deep <= _VARIABLES_DEEP else None
            if end is None:
                return None
            value, rest = self.value(found[1], deep), text[found.end() : end]
            if value is None and rest.startswith(","):
                value = self.put_into(rest[1:].strip(), deep + 1)
            if value is None or len(whole) > _VALUE_LONGEST:
                return None
            whole, at = f"{whole}{text[at : found.start()]}{value}", end + 1
        return whole + text[at:]


def _closing(text: str, start: int) -> int | None:
    """Return where the bracket closes that is open at a place in a text."""
    deep = 1
    for at in range(start, len(text)):
        deep += {"(": 1, ")": -1}.get(text[at], 0)
        if deep == 0:
            return at
    return None


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
