"""Run a search for suggestions to its end."""

from collections.abc import Iterator
from typing import Any

from planner import make_plan
from planner.explain.suggestion import Suggestion
from planner.explain.suggestion_trial import Search


def proven(search: Search) -> Iterator[Suggestion]:
    """Yield the suggestions of a search of which every wish for a plan is granted, whatever time that takes."""
    wish: Any = next(search, None)
    while wish is not None:
        if isinstance(wish, Suggestion):
            yield wish
            wish = next(search, None)
        else:
            try:
                wish = search.send(make_plan(wish.task))
            except StopIteration:
                return
