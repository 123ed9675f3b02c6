"""Sweeps: one test of many cases, a few of which run every time and all of them in `make test-long`."""

from collections.abc import Collection, Iterable

import pytest

QUICK_GARMENTS = ("skirt", "letter-towel")
"""Shipped garments that between them are dragged, folded by one hand and by two, and folded back while held."""


def sweep(name: str, cases: Iterable[str], quick: Collection[str] = QUICK_GARMENTS) -> pytest.MarkDecorator:
    """Give a test each of some cases; those that are not quick are marked long."""
    given = list(cases)
    if missing := set(quick) - set(given):
        raise ValueError(f"there are no such cases: {sorted(missing)}")
    return pytest.mark.parametrize(
        name, [case if case in quick else pytest.param(case, marks=pytest.mark.long) for case in given]
    )
