"""The list of the documents in a folder, page by page.

To put thousands of documents in order takes no more than a look at the folder: what stands at the head of each is
remembered until its files change. The documents of a page are then read whole, once: none looks well that is not.
"""

import os
import threading
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from app.store.document_files import BROKEN, HEAD, ID_PATTERN, JOURNAL, JSON

_SHOWN = (JOURNAL, HEAD, JSON, BROKEN)


@dataclass(frozen=True, slots=True)
class DocumentEntry:
    """A document as the list shows it.

    Attributes:
        id: its id.
        title: the garment's title; empty if the file cannot be read.
        name: the garment's name; likewise.
        changed_at: when it was changed last, UTC, as in RFC 3339; likewise.
        problem: why it cannot be opened, or None.
    """

    id: str
    title: str = ""
    name: str = ""
    changed_at: str = ""
    problem: str | None = None

    @property
    def place(self) -> tuple[str, str]:
        """Where it stands: later ones first, and last of all those that cannot be read."""
        return self.changed_at, self.id


@dataclass(frozen=True, slots=True)
class DocumentPage:
    """A part of the list.

    Attributes:
        entries: the documents.
        end: the place of the last of them; None if no others follow.
    """

    entries: tuple[DocumentEntry, ...]
    end: tuple[str, str] | None


_Stamp = tuple[tuple[str, int, int], ...]
"""Ending, time of the last change (ns) and size of a document's files."""


@dataclass(frozen=True, slots=True)
class _Known:
    stamp: _Stamp
    entry: DocumentEntry
    place: tuple[str, str]
    is_read: bool = False


class DocumentList:
    """The documents in a folder, the one changed last first."""

    def __init__(
        self, folder: Path, glance: Callable[[str], DocumentEntry], read: Callable[[str], DocumentEntry]
    ) -> None:
        """Nothing has been looked at.

        Args:
            folder: the folder.
            glance: tells as quickly as can be what to show of a document.
            read: tells the same, and whether it can be read from beginning to end.
        """
        self._folder = folder
        self._glance = glance
        self._read = read
        self._known: dict[str, _Known] = {}
        self._lock = threading.Lock()

    def ordered(self) -> list[DocumentEntry]:
        """Return all documents after a glance."""
        with self._lock:
            return [known.entry for known in self._in_order()]

    def page(self, after: tuple[str, str] | None, count: int) -> DocumentPage:
        """Return the documents that follow a place."""
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
        """Return a document once it has been read; it keeps its place, so that no other is shown in its stead."""
        if known.is_read:
            return known
        entry = self._read(known.entry.id)
        self._known[entry.id] = _Known(known.stamp, entry, entry.place, is_read=True)
        return replace(known, entry=entry)

    def _stamps(self) -> dict[str, _Stamp]:
        """Return what the files of each document look like from outside."""
        found: defaultdict[str, list[tuple[str, int, int]]] = defaultdict(list)
        with suppress(FileNotFoundError), os.scandir(self._folder) as files:
            for file in files:
                document_id, dot, ending = file.name.rpartition(".")
                if dot + ending not in _SHOWN or not ID_PATTERN.fullmatch(document_id):
                    continue
                with suppress(FileNotFoundError):  # it has just been removed
                    status = file.stat()
                    found[document_id].append((dot + ending, status.st_mtime_ns, status.st_size))
        return {name: tuple(sorted(looks)) for name, looks in found.items() if {one[0] for one in looks} != {HEAD}}
