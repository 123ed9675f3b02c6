"""The page's scripts and styles in one answer each."""

import json
import os
import re
from pathlib import Path

import httpx
import pytest
from tree_sitter import Node

from app import page_files
from app.page_files import scripts, styles
from tests.page.scripts import STATIC, trees

pytestmark = pytest.mark.anyio


def told_modules() -> dict[str, str]:
    found = re.search(r"Object\.entries\((\{.*\})\)\) \{$", scripts(), re.MULTILINE)
    assert found is not None
    modules: dict[str, str] = json.loads(found[1])
    return modules


def named(file: str, root: Node) -> str:
    """Return a script whose imports, and nothing else, name the modules: those that its syntax tree has."""
    source = STATIC / "js" / file
    text = source.read_bytes()
    for statement in reversed(root.children):
        address = statement.child_by_field_name("source")
        if address is not None and address.text is not None:
            path = (source.parent / address.text.decode().strip('"')).resolve().relative_to((STATIC / "js").resolve())
            text = text[: address.start_byte] + f'"page/{path.as_posix()}"'.encode() + text[address.end_byte :]
    return text.decode()


def test_every_module_is_there_unchanged_but_for_the_names_of_what_it_imports() -> None:
    modules = told_modules()
    assert modules == {f"page/{file}": named(file, root) for file, root in trees()}
    imported = re.findall(r'"(page/[^"]+)";$', "".join(modules.values()), re.MULTILINE)
    assert len(imported) > 400
    assert set(imported) <= set(modules)


def test_every_style_sheet_is_there_once() -> None:
    told = styles()
    assert "@import" not in told
    for sheet in (STATIC / "css").glob("*.css"):
        if sheet.name != "page.css":
            assert told.count(sheet.read_text(encoding="utf-8")) == 1, sheet.name


@pytest.mark.parametrize("name", ["page.js", "page.css"])
async def test_a_browser_that_has_them_is_told_so_until_a_file_changes(
    client: httpx.AsyncClient, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder, file, text in (("js", "main.js", 'import "./dom.js";\n'), ("css", "page.css", "a { color: red; }\n")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / file).write_text(text, encoding="utf-8")
    monkeypatch.setattr(page_files, "static_dir", lambda: tmp_path)
    first = await client.get(f"/static/{name}")
    assert first.status_code == 200 and first.headers["cache-control"] == "no-cache"
    assert (await client.head(f"/static/{name}")).headers["etag"] == first.headers["etag"]
    known = {"if-none-match": first.headers["etag"]}
    again = await client.get(f"/static/{name}", headers=known)
    assert again.status_code == 304 and again.content == b""
    changed = next((tmp_path / name.partition(".")[2]).iterdir())
    changed.write_text("/* other */\n", encoding="utf-8")
    os.utime(changed, ns=(1, 1))
    assert (await client.get(f"/static/{name}", headers=known)).status_code == 200
