"""Reads XML safely: it fetches nothing, expands nothing, and refuses what is too large or too deep.

Python's parsers build on expat, which reads no external file or address unless made to. That leaves entities that a
document declares itself, which can grow into gigabytes; a document that declares any is refused. A plain document
type, as drawing programs write it, is ignored.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from app.files.import_errors import ImportedFileError, broken

DEPTH_MAX = 100
"""Largest nesting depth of elements."""

ELEMENTS_MAX = 50_000
"""Largest number of elements."""


@dataclass(slots=True, eq=False)
class Element:
    """An element of a document.

    Attributes:
        tag: its name without namespace.
        attributes: its attributes by name, without namespace.
        line: the line of the file in which it begins.
        children: the child elements, in order.
        text: the text directly in it.
        parent: the element around it; None for the root.
    """

    tag: str
    attributes: dict[str, str]
    line: int
    children: list["Element"] = field(default_factory=list)
    text: str = ""
    parent: "Element | None" = field(default=None, repr=False)

    def walk(self) -> Iterator["Element"]:
        """Yield this element and all its descendants, in document order."""
        waiting = [self]
        while waiting:
            element = waiting.pop()
            yield element
            waiting.extend(reversed(element.children))

    def whole_text(self) -> str:
        """Return the text in this element and all its descendants."""
        return " ".join(" ".join(element.text for element in self.walk()).split())

    @property
    def title(self) -> str | None:
        """The text of the element's title; None without one."""
        found = next((child.text for child in self.children if child.tag == "title"), "")
        return " ".join(found.split()) or None


def read_markup(data: bytes) -> Element:
    """Return the root element of an XML document.

    Raises:
        ImportedFileError: it is not well-formed, declares entities, or has too many or too deep elements.
    """
    return _Builder().read(data)


class _Builder:
    """Builds the tree while expat reads the document."""

    def __init__(self) -> None:
        self._parser = expat.ParserCreate(namespace_separator="}")
        self._parser.buffer_text = True
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._write
        self._parser.EntityDeclHandler = self._declare
        self._open: list[Element] = []
        self._root: Element | None = None
        self._count = 0

    def read(self, data: bytes) -> Element:
        try:
            self._parser.Parse(data, True)
        except expat.ExpatError as error:
            what = expat.errors.messages[error.code]
            raise broken(f"line {error.lineno}, column {error.offset + 1}: {what}") from None
        except ImportedFileError:
            raise
        except (LookupError, ValueError):
            raise broken("its encoding is not known") from None
        if self._root is None:
            raise broken("there is no element in it")
        return self._root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if len(self._open) >= DEPTH_MAX:
            raise self._refusal(f"elements are nested more than {DEPTH_MAX} deep")
        if self._count > ELEMENTS_MAX:
            raise self._refusal(f"there are more than {ELEMENTS_MAX} elements")
        named = {_local(name): value for name, value in attributes.items()}
        element = Element(_local(tag), named, self._parser.CurrentLineNumber)
        if self._open:
            element.parent = self._open[-1]
            self._open[-1].children.append(element)
        else:
            self._root = element
        self._open.append(element)

    def _end(self, _: str) -> None:
        self._open.pop()

    def _write(self, text: str) -> None:
        self._open[-1].text += text

    def _declare(self, name: str, *_: object) -> None:
        message = f"it declares an entity of its own ({name[:40]!r}), which is not read; save it as plain SVG"
        raise self._refusal(message)

    def _refusal(self, message: str) -> ImportedFileError:
        return broken(f"line {self._parser.CurrentLineNumber}: {message}")


def _local(name: str) -> str:
    return name.rpartition("}")[2]
