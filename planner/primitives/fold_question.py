"""Where may the base stand while one fold is performed? Asked as lazily as the search allows.

To ask for every approach of every hand at every back-off is to ask for tens of thousands of places, for one fold. But
a search wants to know the cheapest ends first and mostly never comes to ask for the others; and mostly the base need
not drive at all. So it is asked for no driving first, then for the least that there may be, and for more only when
nothing cheaper is left.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE, Driving
from planner.primitives.fold_trial import FoldTrial, fold_trials, geometric_obstacle
from planner.primitives.fold_way import FoldWay, attempt_of
from planner.primitives.state import State
from planner.primitives.work import Work


@dataclass(frozen=True, eq=False, slots=True)
class End:
    """A place where the base may stand after a fold.

    Attributes:
        back_off: that place.
        steps: the least steps of driving in all.
        first: where the base stands then when the hands begin.
        way: the way that needs so few.
    """

    back_off: int
    steps: int
    first: int
    way: FoldWay


class FoldQuestion:
    """One fold, from one station, of the article at one place, with what is held."""

    def __init__(self, work: Work, state: State, fold: int, begun: NDArray[np.int64]) -> None:
        """What can be tried; what speaks against it is noted.

        Args:
            work: the problem.
            state: with any back-off.
            fold: the fold's index.
            begun: for each back-off of a state a row: the steps in which the base can be at each back-off when the
                hands begin.
        """
        self._work = work
        self._state = state
        self._begun = begun
        self._trials = tuple(self._search(fold))
        self._hands = tuple(trial.following(work, state.station) for trial in self._trials)
        self._is_noted = False

    def _search(self, fold: int) -> Iterator[FoldTrial]:
        obstacle = geometric_obstacle(self._work, self._state, fold)
        if obstacle is None:
            yield from fold_trials(self._work, self._state, fold)
        else:
            self._work.obstacles.note(obstacle)

    @cached_property
    def least_steps(self) -> int:
        """The least steps that any way takes, wherever the hands begin; `IMPOSSIBLE` if there is no way."""
        anywhere = np.zeros(self._work.back_offs, dtype=np.int64)
        found = (hands.least_driving(anywhere) for hands in self._hands)
        return min((int(driving.steps.min()) for driving in found), default=IMPOSSIBLE)

    def ends(self, back_off: int, least: int, most: int) -> tuple[list[End], int]:
        """The ends that take so many steps, no less and no more, and that cannot be had as cheaply by driving on.

        Args:
            back_off: where the base stands.
            least: ends of fewer steps are left out.
            most: and so are those of more.

        Returns:
            The ends, and the least steps that others may take; `IMPOSSIBLE` if there are none.
        """
        found = [hands.least_driving(self._begun[back_off], most) for hands in self._hands]
        ends = [end for number, driving in enumerate(found) for end in self._ends(number, driving)]
        kept = [end for i, end in enumerate(ends) if not any(_beats(other, end, j < i) for j, other in enumerate(ends))]
        more = min((driving.more for driving in found), default=IMPOSSIBLE)
        if not ends and more == IMPOSSIBLE:
            self._note_out_of_reach()
        return [end for end in kept if end.steps >= least], more

    def every_end(self, back_off: int) -> list[End]:
        """All ends, and of each choice of grips and arms."""
        begun = self._begun[back_off]
        found = (hands.least_driving(begun, wanted="every") for hands in self._hands)
        ends = [end for number, driving in enumerate(found) for end in self._ends(number, driving)]
        if not ends:
            self._note_out_of_reach()
        return ends

    def _ends(self, number: int, driving: Driving) -> Iterator[End]:
        trial = self._trials[number]
        for end in driving.ends:
            way = FoldWay(trial, driving.approaches(end, trial.approaches))
            yield End(end, int(driving.steps[end]), int(driving.first[end]), way)

    def _note_out_of_reach(self) -> None:
        """Remember that the arms cannot follow, once."""
        if not self._is_noted:
            self._is_noted = True
            for trial in self._trials:
                self._work.obstacles.note_attempt(attempt_of(self._state, trial, np.array([self._state.offset])))


def _beats(one: End, other: End, is_before: bool) -> bool:
    """Whether one end makes another useless: it can be had as cheaply by driving on from it."""
    away = abs(one.back_off - other.back_off)
    return one is not other and one.steps + away <= other.steps and (away > 0 or one.steps < other.steps or is_before)


class FoldQuestions:
    """Many states of a search ask the same question, so answers are kept."""

    def __init__(self, work: Work) -> None:
        self._work = work
        self._kept: dict[tuple[object, ...], FoldQuestion] = {}
        places = np.arange(work.back_offs)
        away = np.abs(places[:, None] - places)
        self._driven = {False: away, True: np.where(away > 0, IMPOSSIBLE, 0)}

    def of(self, state: State, fold: int) -> FoldQuestion:
        """What is asked about a fold in a state; states that differ in their back-off share it."""
        done, x, y, station, _, held, is_dragged = state.key
        key = (done, x, y, station, held, is_dragged, fold)
        if key not in self._kept:
            self._kept[key] = FoldQuestion(self._work, state, fold, self._driven[bool(state.held)])
        return self._kept[key]
