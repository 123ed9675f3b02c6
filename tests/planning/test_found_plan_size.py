"""A found plan is remembered by the dozen on a server, so it must not hold what only the search needed."""

import gc
import sys
import types
from collections.abc import Iterable, Iterator

import numpy as np
import pytest

from planner import load_garment
from planner.robots.load_robot import load_robot
from tests.planning.found import found_plan

_NOT_ITS_OWN = (types.ModuleType, type, types.FunctionType, types.BuiltinFunctionType, types.CodeType)


def reachable(roots: Iterable[object], but: frozenset[int] = frozenset()) -> Iterator[object]:
    """Yield all objects that some refer to, directly or not, each once."""
    seen, todo = set(but), list(roots)
    while todo:
        one = todo.pop()
        if id(one) not in seen and not isinstance(one, _NOT_ITS_OWN):
            seen.add(id(one))
            yield one
            todo.extend(gc.get_referents(one))
            if isinstance(one, np.ndarray) and one.base is not None:
                todo.append(one.base)


@pytest.mark.parametrize("name", ["t-shirt", "scarf"])
def test_a_found_plan_holds_its_steps_and_their_paths_and_no_more(name: str) -> None:
    # The scarf's held 7 MB: the joint paths of every transfer that was tried, and the restricted tasks' answers.
    found = found_plan(load_garment(name))
    robots = [*reachable([load_robot("pr2")])]
    shared = frozenset(map(id, robots))
    size_mb = sum(sys.getsizeof(one) for one in reachable([found.plan_segments, found.context], shared)) / 1e6
    assert size_mb < 1.2, f"{size_mb:.1f} MB"
