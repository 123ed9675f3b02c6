"""The page's scripts and styles, each kind in one answer: a visit asks for a dozen files and not for two hundred.

The files stay what they are, modules and style sheets that a browser reads as they stand. Put together, a module keeps
its own scope: the answer holds the text of each, and an import map leads from its name, as in `page/board/snap.js`, to
that text.
"""

import json
import re
from functools import lru_cache
from pathlib import Path

_HERE = Path(__file__).resolve().parent
_FROM = re.compile(r'^((?:import|export)(?:\s[^;"()=]*\bfrom)?\s*)"(\.{1,2}/[^"]+)"', re.MULTILINE)
_STYLES = re.compile(r'^@import "\./([^"]+)";$', re.MULTILINE)

# A module is named in a debugger as it lies in the folder. Its address holds its text: a blob's would be asked for, one
# after the other, in the browser's main process.
_SCRIPT = """\
const imports = {{}};
for (const [name, text] of Object.entries({texts})) {{
  const source = `${{text}}\\n//# sourceURL=${{name}}`;
  imports[name] = `data:text/javascript;charset=utf-8,${{encodeURIComponent(source)}}`;
}}
const map = document.createElement("script");
map.type = "importmap";
map.textContent = JSON.stringify({{ imports }});
document.currentScript.after(map);
"""


def static_dir() -> Path:
    """Return the page's folder: inside an installed package, beside the packages in a checkout."""
    installed = _HERE / "static"
    return installed if installed.is_dir() else _HERE.parent / "static"


def scripts() -> str:
    """Return a classic script after which all modules of `static/js` can be imported, as in `page/main.js`."""
    folder = static_dir() / "js"
    return _scripts(folder, _stamps(folder))


def styles() -> str:
    """Return `static/css/page.css` with the sheets that it imports in their places."""
    folder = static_dir() / "css"
    return _styles(folder, _stamps(folder))


def _stamps(folder: Path) -> tuple[tuple[Path, int], ...]:
    """Return what tells whether a file of the folder has changed: each file and when it was written (ns)."""
    return tuple((file, file.stat().st_mtime_ns) for file in sorted(folder.rglob("*.*")))


@lru_cache(maxsize=2)
def _scripts(folder: Path, stamps: tuple[tuple[Path, int], ...]) -> str:
    modules = [file for file, _ in stamps if file.suffix == ".js"]
    return _SCRIPT.format(texts=json.dumps({_name(file, folder): _module(file, folder) for file in modules}))


def _module(file: Path, folder: Path) -> str:
    """Return the text of a module that imports the others by name."""

    def named(found: re.Match[str]) -> str:
        return f'{found[1]}"{_name((file.parent / found[2]).resolve(), folder.resolve())}"'

    return _FROM.sub(named, file.read_text(encoding="utf-8"))


def _name(file: Path, folder: Path) -> str:
    return f"page/{file.relative_to(folder).as_posix()}"


@lru_cache(maxsize=2)
def _styles(folder: Path, stamps: tuple[tuple[Path, int], ...]) -> str:
    texts = {file.name: file.read_text(encoding="utf-8") for file, _ in stamps}
    return _STYLES.sub(lambda found: texts[found[1]], texts["page.css"])
