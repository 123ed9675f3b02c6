"""Random operations on a document in two windows and over REST: no state is lost and none is stale.

What comes of them is told by the model that the server is tested with (`tests.app.document_model`). A hand acts on what
its window shows, so it waits until that is what the server has; it does not wait for plans.
"""

import math
from collections.abc import Callable, Iterator

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)
from playwright.sync_api import Browser

from tests.app.samples import towel
from tests.browser.board_hand import Point
from tests.browser.board_window import Window
from tests.browser.conftest import REST, Garment, Sheet, windows
from tests.browser.two_windows import SLACK_PX, TwoWindows, assert_shown, beginning
from tests.patience import wait_until

CORNERS_MAX = 7
FOLDS_MAX = 3
ROOM_M = 0.03
HANDLE_PX = 14.0
"""The distance (px) that a point on an edge keeps from everything else, since the hand takes what is within it."""

COLOURS = {"blue": "Blue: all layers", "red": "Red: last flap"}

either = st.sampled_from([0, 1])
anybody = st.sampled_from([0, 1, None])
"""One of the windows, or REST."""

numbers = st.integers(0, 6)
pulls = st.tuples(st.integers(-3, 3), st.integers(-3, 3)).filter(any)
"""Displacements to the right and up (cm)."""


class PageMachine(TwoWindows):
    """Operations on one document, and the invariants of what is shown."""

    @initialize()
    def begin(self) -> None:
        """Put a towel in place of the last garment; undo goes no further back."""
        for window in self.windows:
            window.let_go()
        body = {"garment": towel(title=self.new_title()), "label": "Begin"}
        self.state = REST.put(f"{self.sheet.path}/garment", json=body).raise_for_status().json()
        self.model.past.append(("Begin", {}))

    # rules: what hands do in a window

    @rule(who=either, which=numbers, pull=pulls)
    def drag_a_corner(self, who: int, which: int, pull: tuple[int, int]) -> None:
        window, index, target = self.grasp(who, which, pull)
        window.end_drag()
        self.done("Move vertex")
        self.assert_moved(window, index, target)

    @rule(who=either, which=numbers, pull=pulls)
    def drop_a_drag(self, who: int, which: int, pull: tuple[int, int]) -> None:
        window, _, _ = self.grasp(who, which, pull)
        window.page.keyboard.press("Escape")
        window.page.mouse.up()
        self.none_done()

    @rule(who=either, which=numbers, pull=pulls)
    def undo_in_the_other_window_during_a_drag(self, who: int, which: int, pull: tuple[int, int]) -> None:
        """Undo in the other window during a drag: the drag's step is undone, and the drop is one more step."""
        before = self.state["drawing"]
        window, index, target = self.grasp(who, which, pull)
        dragged = self.sheet.state
        self.model.edit("preview", "Move vertex", "drag", before, dragged["drawing"])
        self.state = dragged
        self.undo(1 - who)
        assert self.state["drawing"] == before
        window.end_drag()
        self.done("Move vertex")
        self.assert_moved(window, index, target)

    @rule(who=either, which=numbers, pull=pulls)
    def rename_over_rest_during_a_drag(self, who: int, which: int, pull: tuple[int, int]) -> None:
        """Rename over REST during a drag: the drag becomes a step of its own, and the drop adds nothing."""
        before = self.state["drawing"]
        window, index, target = self.grasp(who, which, pull)
        dragged = self.sheet.state
        self.model.edit("preview", "Move vertex", "drag", before, dragged["drawing"])
        self.model.close_gesture(dragged["drawing"])
        self.state = dragged
        self.sheet.edit(lambda drawing: drawing.update(title=self.new_title()))
        self.done("Elsewhere")
        window.end_drag()
        assert self.sheet.drawing == self.state["drawing"]
        self.state = self.sheet.state
        self.assert_moved(window, index, target)

    @precondition(lambda self: len(self.outline) < CORNERS_MAX)
    @rule(who=either, which=numbers, share=st.sampled_from([0.3, 0.7]))
    def add_a_corner(self, who: int, which: int, share: float) -> None:
        index = which % len(self.outline)
        a, b = self.outline[index], self.outline[(index + 1) % len(self.outline)]
        at = (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))
        others = [end["point"] for fold in self.folds for end in (fold["start"], fold["end"])]
        window = self.hand(who)
        window.clear()
        room_m = max(ROOM_M, HANDLE_PX * window.pixel_m())
        if min(math.dist(at, other) for other in [*self.outline, *others]) < room_m or self.state["problems"]:
            return
        window.add_corner(at)
        before = self.outline
        self.done("Add vertex")
        assert math.dist(self.outline[index + 1], at) < SLACK_PX * window.pixel_m()
        assert [*self.outline[: index + 1], *self.outline[index + 2 :]] == before

    @precondition(lambda self: len(self.outline) > 3)
    @rule(who=either, which=numbers)
    def remove_a_corner(self, who: int, which: int) -> None:
        index, before = which % len(self.outline), self.outline
        self.hand(who).remove_corner(self.outline[index])
        self.done("Delete vertex")
        assert self.outline == [*before[:index], *before[index + 1 :]]

    @precondition(lambda self: len(self.folds) < FOLDS_MAX and self.state["steps"])
    @rule(who=either, colour=st.sampled_from(list(COLOURS)), first=numbers, second=numbers)
    def draw_a_fold(self, who: int, colour: str, first: int, second: int) -> None:
        """Draw a fold from the middle of an edge of the cloth as it lies to that of another; it may be refused."""
        rings = self.state["steps"][-1]["flap" if colour == "red" else "silhouette"]
        ring = rings[0] if rings else self.outline
        a, b = (_middle(ring, number % len(ring)) for number in (first, second))
        if math.dist(a, b) < ROOM_M:
            return
        window = self.hand(who)
        refused, before = window.refusals(), self.folds
        window.draw_fold(a, b, COLOURS[colour])
        wait_until(lambda: len(self.sheet.drawing["folds"]) > len(before) or window.refusals() > refused)
        if window.refusals() > refused:
            self.none_done()
            return
        self.done("Draw fold")
        (drawn,) = (fold for fold in self.folds if fold["id"] not in [known["id"] for known in before])
        assert drawn["kind"] == colour

    @precondition(lambda self: self.folds)
    @rule(who=either, which=numbers)
    def remove_a_fold(self, who: int, which: int) -> None:
        gone = self.folds[which % len(self.folds)]["id"]
        left = [fold["id"] for fold in self.folds if fold["id"] != gone]
        self.hand(who).remove_fold(which % len(self.folds))
        self.done("Delete fold")
        assert [fold["id"] for fold in self.folds] == left

    @precondition(lambda self: self.folds)
    @rule(who=either, which=numbers)
    def paint_a_fold(self, who: int, which: int) -> None:
        index = which % len(self.folds)
        colour = "red" if self.folds[index]["kind"] == "blue" else "blue"
        self.hand(who).paint_fold(index, COLOURS[colour])
        self.done(f"Make fold {colour}")
        assert self.folds[index]["kind"] == colour

    @precondition(lambda self: self.folds)
    @rule(who=either, which=numbers)
    def flip_a_fold(self, who: int, which: int) -> None:
        index = which % len(self.folds)
        before = self.folds[index]
        self.hand(who).flip_fold(index)
        self.done("Flip fold")
        assert math.dist(self.folds[index]["start"]["point"], before["end"]["point"]) < ROOM_M

    @rule(who=either)
    def rename(self, who: int) -> None:
        title = self.new_title()
        self.hand(who).rename(title)
        self.done("Rename garment")
        assert self.state["drawing"]["title"] == title

    @rule(who=either, ahead_cm=st.integers(-60, -40))
    def place(self, who: int, ahead_cm: int) -> None:
        before = self.state["drawing"]["placement"]
        # Turned by -90 degrees: the garment's y is the table's x.
        middle_m = before["x_m"] + (max(y for _, y in self.outline) + min(y for _, y in self.outline)) / 2
        if round(100 * middle_m, 1) == ahead_cm:
            return
        self.hand(who).place(ahead_cm)
        self.done("Place garment")
        moved_m = self.state["drawing"]["placement"]["x_m"] - before["x_m"]
        assert moved_m == pytest.approx(0.01 * ahead_cm - middle_m, abs=1e-9)

    @rule(who=either)
    def reload(self, who: int) -> None:
        self.windows[who].page.reload()
        self.windows[who].look_at(self.state["version"])

    # rules: what anybody does

    @rule(pull=pulls, which=numbers)
    def move_a_corner_over_rest(self, which: int, pull: tuple[int, int]) -> None:
        index, target = self.target(which, pull)
        self.sheet.edit(lambda drawing: drawing["outline"][index].update(point=list(target)))
        self.done("Elsewhere")
        assert self.outline[index] == target

    @precondition(lambda self: len(self.model.past) > 1)
    @rule(who=anybody)
    def undo(self, who: int | None) -> None:
        wanted = self.model.undo(self.state["drawing"])
        self.go("undo", who, self.state["history"]["can_undo"] or self.state["gesture"])
        assert self.state["drawing"] == wanted

    @rule(who=anybody)
    def redo(self, who: int | None) -> None:
        wanted = self.model.redo(self.state["drawing"])
        self.go("redo", who, self.state["history"]["can_redo"])
        assert self.state["drawing"] == wanted

    @precondition(lambda self: len(self.model.past) > 1)
    @rule(who=anybody, other=anybody)
    def undo_and_redo(self, who: int | None, other: int | None) -> None:
        before = self.state
        self.undo(who)
        self.redo(other)
        assert self.state["drawing"] == before["drawing"]
        assert self.state["history"] == before["history"]

    @rule()
    def rest(self) -> None:
        """Wait until nothing is in progress; both windows show the document with its own plan."""
        state = self.sheet.state
        for window in self.windows:
            window.wait_for_answer(state["version"])
        one, other = (window.shown() for window in self.windows)
        assert_shown(one, state)
        assert_shown(other, state)
        plan = self.planned(state)
        for shown in (one, other):
            assert shown["status"] == plan["status"]
            assert shown["primitives"] == len(plan["primitives"])
            assert shown["text"].startswith(beginning(plan))
        assert one["text"] == other["text"]
        assert self.sheet.state == state

    @invariant()
    def nothing_is_lost(self) -> None:
        found = self.sheet.state
        assert found["drawing"] == self.state["drawing"]
        assert found["history"] == self.model.history
        assert found["gesture"] is None

    def teardown(self) -> None:
        self.rest()


def _middle(ring: list[list[float]] | list[Point], edge: int) -> Point:
    (ax, ay), (bx, by) = ring[edge], ring[(edge + 1) % len(ring)]
    return (ax + bx) / 2, (ay + by) / 2


@pytest.fixture
def two(chromium: Browser, sheet: Sheet) -> Iterator[tuple[Window, Window]]:
    """Open two windows, each of its own: a browser draws only one of two tabs."""
    size = {"width": 900, "height": 500}
    with windows(chromium, viewport=size) as one, windows(chromium, viewport=size) as other:
        first, second = Window(one.new_page()), Window(other.new_page())
        for window in (first, second):
            window.count_refusals()
            window.open(sheet)
        yield first, second


@pytest.fixture
def sheet(new_sheet: Callable[[Garment], Sheet]) -> Sheet:
    return new_sheet(towel())


@pytest.mark.long
def test_two_windows_and_rest_lose_nothing_and_show_nothing_stale(two: tuple[Window, Window], sheet: Sheet) -> None:
    tries = settings().max_examples
    run_state_machine_as_test(
        lambda: PageMachine(two, sheet),  # type: ignore[arg-type]
        settings=settings(max_examples=max(4, tries // 25), stateful_step_count=max(8, tries // 50)),
    )
