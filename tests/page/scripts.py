"""The page's scripts as syntax trees: their texts, and where each stands."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import tree_sitter_javascript
from tree_sitter import Language, Node, Parser

STATIC = Path(__file__).parents[2] / "static"
SCRIPTS = STATIC / "js"


@dataclass(frozen=True, slots=True)
class Text:
    """A string or a template, its places shown as braces.

    Attributes:
        file: the script, below `static/js`.
        line: its line, from 1.
        words: what it says.
        context: what it is in: the function and the argument's number, the property, or the kind of syntax.
    """

    file: str
    line: int
    words: str
    context: str


@dataclass(frozen=True, slots=True)
class Call:
    """A call with a key of the catalogue.

    Attributes:
        file: the script, below `static/js`.
        line: its line, from 1.
        key: the key as a pattern, anything in its places.
        names: the names of the values that are given; None if they are not written out.
    """

    file: str
    line: int
    key: str
    names: frozenset[str] | None


@cache
def trees() -> tuple[tuple[str, Node], ...]:
    """Return the tree of each script by its path below `static/js`."""
    parser = Parser(Language(tree_sitter_javascript.language()))
    files = sorted(SCRIPTS.rglob("*.js"))
    return tuple((str(file.relative_to(SCRIPTS)), parser.parse(file.read_bytes()).root_node) for file in files)


def texts() -> Iterator[Text]:
    """Yield all texts except the addresses of imports."""
    for file, root in trees():
        for node in _walk(root):
            if node.type in {"string", "template_string"} and _parent(node).type != "import_statement":
                yield Text(file, node.start_point[0] + 1, _plain(node), _context(node))


def calls(names: frozenset[str]) -> Iterator[Call]:
    """Yield the calls of some functions whose first argument is a key, or a choice between keys."""
    for file, root in trees():
        for node in _walk(root):
            if node.type == "call_expression" and _source(node.child_by_field_name("function")) in names:
                first, *others = _arguments(node)
                for key in _keys(first):
                    yield Call(file, node.start_point[0] + 1, key, _names(others))


def _keys(node: Node) -> Iterator[str]:
    if node.type == "ternary_expression":
        for branch in ("consequence", "alternative"):
            part = node.child_by_field_name(branch)
            assert part is not None
            yield from _keys(part)
    elif node.type in {"string", "template_string"}:
        yield re.escape(_plain(node)).replace(r"\{\}", ".*")


def _names(values: list[Node]) -> frozenset[str] | None:
    if not values:
        return frozenset()
    found = set()
    for part in values[0].named_children:
        if part.type == "shorthand_property_identifier":
            found.add(_source(part))
        elif part.type == "pair":
            found.add(_source(part.child_by_field_name("key")))
        else:
            return None
    return frozenset(found) if values[0].type == "object" else None


def _arguments(call: Node) -> list[Node]:
    arguments = call.child_by_field_name("arguments")
    return [] if arguments is None else [part for part in arguments.named_children if part.type != "comment"]


def _walk(node: Node) -> Iterator[Node]:
    yield node
    for child in node.named_children:
        yield from _walk(child)


def _source(node: Node | None) -> str:
    return "" if node is None or node.text is None else node.text.decode()


def _parent(node: Node) -> Node:
    assert node.parent is not None
    return node.parent


def _plain(node: Node) -> str:
    """Return what a text says, with braces for its places."""
    parts = ["{}" if part.type == "template_substitution" else _source(part) for part in node.named_children]
    return re.sub(r"\\u([0-9A-Fa-f]{4})", lambda found: chr(int(found[1], 16)), "".join(parts))


def _context(node: Node) -> str:
    """Return what a text is in; of a choice or a sum, what that is in."""
    parent, child = _parent(node), node
    while parent.type in {"ternary_expression", "binary_expression", "parenthesized_expression", "array"}:
        is_compared = (
            parent.type == "binary_expression" and _source(parent.child_by_field_name("operator")) in _COMPARED
        )
        if is_compared or child == parent.child_by_field_name("condition"):
            return "comparison"
        parent, child = _parent(parent), parent
    if parent.type == "arguments":
        call = _parent(parent)
        function = call.child_by_field_name("function") or call.child_by_field_name("constructor")
        return f"{_source(function).split('.')[-1]}#{parent.named_children.index(child)}"
    if parent.type == "pair":
        return _source(parent.child_by_field_name("key"))
    if parent.type == "assignment_expression":
        return _source(parent.child_by_field_name("left")).split(".")[-1]
    return parent.type


_COMPARED = {"===", "!==", "in"}
