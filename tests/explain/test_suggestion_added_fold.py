"""A fold that is too large for two hands is offered in two parts, or after the cloth has been halved across it."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from planner import FoldSequence, Garment, Task
from planner.explain.suggestion_added_fold import halvings, splits, with_fold_before
from planner.explain.suggestion_trial import Search
from planner.geometry.segment import Segment
from tests.builders import fold, garment, rectangle_points
from tests.explain.proven_search import proven
from tests.planning.provoked import planned_with

APRON = ((0, 0), (0.7, 0), (0.7, 0.5), (0.56, 0.58), (0.5, 0.9), (0.35, 0.88), (0.2, 0.9), (0.14, 0.58), (0, 0.5))
"""Nine corners; halved lengthwise, three corners far from each other must be held."""


@pytest.fixture(scope="module")
def apron() -> Garment:
    cloth = garment(APRON, fold((0.35, 0.0), (0.35, 0.88)))
    assert not FoldSequence.of(cloth).covers(0, 0.0873, 2).is_holdable
    return cloth


@pytest.mark.parametrize(("search", "code"), [(splits, "split_fold"), (halvings, "halve_first")])
def test_an_apron_halved_lengthwise_first_is_done_with_one_more_fold(
    apron: Garment, search: Callable[[Task, Sequence[int]], Search], code: str
) -> None:
    found = next(proven(search(Task.of(apron), (0,))))
    assert found.says.code == code
    assert len(found.change["garment"]["folds"]) == 2
    assert planned_with(found.change, apron).cost_s == pytest.approx(found.cost_s, abs=1e-9)


def test_a_split_fold_leaves_the_same_cloth_on_the_side_that_stays(apron: Garment) -> None:
    found = next(proven(splits(Task.of(apron), (0,))))
    before = FoldSequence.of(apron).final.silhouette
    after = FoldSequence.of(Garment.from_dict(found.change["garment"])).final.silhouette
    assert after.difference(before).is_sliver


def test_a_fold_before_another_cuts_later_lines_to_the_cloth_as_it_is_then() -> None:
    cloth = garment(rectangle_points(0.6, 0.4), fold((0.3, 0.0), (0.3, 0.4)))
    changed = with_fold_before(cloth, 0, Segment((0.6, 0.2), (0.0, 0.2)))
    assert changed is not None
    ends = [[*one.start, *one.end] for one in changed.folds]
    assert np.allclose(ends, [[0.6, 0.2, 0.0, 0.2], [0.3, 0.2, 0.3, 0.4]], atol=1e-4)


def test_where_the_line_misses_the_cloth_no_fold_is_added() -> None:
    cloth = garment(rectangle_points(0.6, 0.4), fold((0.3, 0.0), (0.3, 0.4)))
    assert with_fold_before(cloth, 0, Segment((2.0, 0.0), (2.0, 0.4))) is None
