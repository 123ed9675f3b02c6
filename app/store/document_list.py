"""Lists the documents in a folder, page by page.

To sort thousands of documents, the list only scans the folder and caches each document's entry until its files change.
Then it reads the documents of the requested page completely, once each, so that a damaged one is never shown as fine.
"""

import os
import threading
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from app.store.document_files import BROKEN, HEAD, ID_PATTERN, JOURNAL, JSON
from app.store.picture import Picture

_SHOWN = (JOURNAL, HEAD, JSON, BROKEN)


@dataclass(frozen=True, slots=True)
class DocumentEntry:
    """A document as listed.

    Attributes:
        id: its id.
        title: the garment's title; empty if the file cannot be read.
        name: the garment's name; empty if the file cannot be read.
        changed_at: the time of the last change, UTC, as in RFC 3339; empty if the file cannot be read.
        problem: why it cannot be opened, or None.
        picture: what it looks like; None where the file was only glanced at, or cannot be read.
    """

    id: str
    title: str = ""
    name: str = ""
    changed_at: str = ""
    problem: str | None = None
    picture: Picture | None = None

    @property
    def place(self) -> tuple[str, str]:
        """The sort key: latest changed first, unreadable ones last."""
        return self.changed_at, self.id


@dataclass(frozen=True, slots=True)
class DocumentPage:
    """A page of the list.

    Attributes:
        entries: the documents.
        end: the place of the last of them; None on the last page.
    """

    entries: tuple[DocumentEntry, ...]
    end: tuple[str, str] | None


_Stamp = tuple[tuple[str, int, int], ...]
"""Ending, time of the last change (ns) and size of each of a document's files."""


@dataclass(frozen=True, slots=True)
class _Known:
    stamp: _Stamp
    entry: DocumentEntry
    place: tuple[str, str]
    is_read: bool = False


class DocumentList:
    """The documents in a folder, the latest changed first."""

    def __init__(
        self, folder: Path, glance: Callable[[str], DocumentEntry], read: Callable[[str], DocumentEntry]
    ) -> None:
        """Start without reading anything.

        Args:
            folder: the folder.
            glance: returns a document's entry as quickly as possible.
            read: returns a document's entry after reading all of it.
        """
        self._folder = folder
        self._glance = glance
        self._read = read
        self._known: dict[str, _Known] = {}
        self._lock = threading.Lock()

    def ordered(self) -> list[DocumentEntry]:
        """Return the entries of all documents, after a glance at each."""
        with self._lock:
            return [known.entry for known in self._in_order()]

    def page(self, after: tuple[str, str] | None, count: int) -> DocumentPage:
        """Return the documents after a place."""
        with self._lock:
            following = [known for known in self._in_order() if after is None or known.place < after]
            shown = [self._as_read(known) for known in following[:count]]
        end = shown[-1].place if len(following) > count else None
        return DocumentPage(tuple(known.entry for known in shown), end)

    def _in_order(self) -> list[_Known]:
        stamps = self._stamps()
        for gone in self._known.keys() - stamps.keys():
            del self._known[gone]
        for document_id, stamp in stamps.items():
            known = self._known.get(document_id)
            if known is None or known.stamp != stamp:
                entry = self._glance(document_id)
                self._known[document_id] = _Known(stamp, entry, entry.place)
        return sorted(self._known.values(), key=lambda known: known.place, reverse=True)

    def _as_read(self, known: _Known) -> _Known:
        """Return a document's entry after reading it, at its old place, so that the page does not shift."""
        if known.is_read:
            return known
        entry = self._read(known.entry.id)
        self._known[entry.id] = _Known(known.stamp, entry, entry.place, is_read=True)
        return replace(known, entry=entry)

    def _stamps(self) -> dict[str, _Stamp]:
        """Return the stamp of each document's files."""
        found: defaultdict[str, list[tuple[str, int, int]]] = defaultdict(list)
        with suppress(FileNotFoundError), os.scandir(self._folder) as files:
            for file in files:
                document_id, dot, ending = file.name.rpartition(".")
                if dot + ending not in _SHOWN or not ID_PATTERN.fullmatch(document_id):
                    continue
                with suppress(FileNotFoundError):  # it was removed meanwhile
                    status = file.stat()
                    found[document_id].append((dot + ending, status.st_mtime_ns, status.st_size))
        return {name: tuple(sorted(looks)) for name, looks in found.items() if {one[0] for one in looks} != {HEAD}}
