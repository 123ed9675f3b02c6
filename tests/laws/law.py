"""The number of cases for a law: a few in every run, thousands in a long one; and a count of them."""

from collections import Counter
from collections.abc import Callable
from functools import wraps
from typing import Any

from hypothesis import settings

LONG = "long"
"""The name of the profile in which laws are tried at length."""

TRIED: Counter[str] = Counter()
"""The number of cases tried so far, by kind of law."""

Test = Callable[..., Any]


def law(kind: str, *, short: int, long: int) -> Callable[[Test], Test]:
    """A test that random cases are given to (write it under `given`): so many of them, and each is counted.

    Args:
        kind: what sort of case it is, "geometry" or "planning"; the closing summary adds up each sort.
        short: how many cases in an ordinary run.
        long: how many in a long one.
    """
    cases = long if settings.get_current_profile_name() == LONG else short

    def counted(test: Test) -> Test:
        @wraps(test)
        def once(*args: Any, **kwargs: Any) -> None:
            TRIED[kind] += 1
            test(*args, **kwargs)

        return settings(max_examples=cases)(once)

    return counted
