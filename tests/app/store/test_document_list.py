"""The list of documents, page by page."""

import itertools
from pathlib import Path

import pytest

from app.store.document_list import DocumentEntry, DocumentList


class Folder:
    """Files named like documents, with a count of the reads of each."""

    def __init__(self, path: Path, count: int) -> None:
        self.path = path
        self.glanced: list[str] = []
        self.was_read: list[str] = []
        self.broken: set[str] = set()
        for number in range(count):
            self.put(f"doc{number:05}")
        self.list = DocumentList(path, self.glance, self.read)

    def put(self, document_id: str, content: str = "") -> None:
        (self.path / f"{document_id}.journal").write_text(content)

    def glance(self, document_id: str) -> DocumentEntry:
        self.glanced.append(document_id)
        return DocumentEntry(document_id, changed_at=f"2026-01-{int(document_id[3:]) % 28:02}")

    def read(self, document_id: str) -> DocumentEntry:
        self.was_read.append(document_id)
        if document_id in self.broken:
            return DocumentEntry(document_id, problem="broken")
        return DocumentEntry(document_id, changed_at=f"2026-01-{int(document_id[3:]) % 28:02}")

    def all_pages(self, size: int) -> list[list[DocumentEntry]]:
        pages, after = [], None
        while True:
            page = self.list.page(after, size)
            pages.append(list(page.entries))
            if page.end is None:
                return pages
            after = page.end


@pytest.mark.parametrize("size", [1, 7, 100, 1000])
def test_the_pages_have_all_documents_once_the_one_changed_last_first(tmp_path: Path, size: int) -> None:
    pages = Folder(tmp_path, 100).all_pages(size)
    shown = list(itertools.chain(*pages))
    assert {entry.id for entry in shown} == {f"doc{number:05}" for number in range(100)}
    assert len(shown) == 100
    assert [entry.changed_at for entry in shown] == sorted((entry.changed_at for entry in shown), reverse=True)
    assert all(len(page) == size for page in pages[:-1])


def test_only_the_documents_of_the_page_are_read_and_only_once(tmp_path: Path) -> None:
    folder = Folder(tmp_path, 50)
    first = folder.list.page(None, 5).entries
    assert folder.was_read == [entry.id for entry in first]
    assert folder.list.page(None, 5).entries == first
    assert len(folder.was_read) == 5
    assert sorted(folder.glanced) == sorted(set(folder.glanced))
    folder.put(first[2].id, "something else")
    folder.list.page(None, 5)
    assert folder.was_read[5:] == [first[2].id]


def test_one_that_turns_out_broken_is_told_at_once_and_stands_at_the_end_from_then_on(tmp_path: Path) -> None:
    folder = Folder(tmp_path, 20)
    spoilt = folder.list.page(None, 20).entries[3].id
    folder.broken.add(spoilt)
    folder.put(spoilt, "spoilt")
    assert [entry.id for entry in folder.list.page(None, 20).entries if entry.problem] == [spoilt]
    assert folder.list.page(None, 20).entries[-1].id == spoilt


def test_a_list_gone_through_while_documents_come_and_go_still_ends(tmp_path: Path) -> None:
    folder = Folder(tmp_path, 30)
    page = folder.list.page(None, 10)
    seen = [entry.id for entry in page.entries]
    (tmp_path / f"{seen[-1]}.journal").unlink()
    folder.put("doc00099")
    while page.end is not None:
        page = folder.list.page(page.end, 10)
        seen += [entry.id for entry in page.entries]
    assert {f"doc{number:05}" for number in range(30)} <= set(seen)
    assert len(seen) == len(set(seen))


def test_a_folder_that_is_not_there_yet_has_no_documents(tmp_path: Path) -> None:
    empty = DocumentList(tmp_path / "none", DocumentEntry, DocumentEntry)
    assert empty.page(None, 10).entries == ()
