"""A document in two windows: its known state, waiting for operations, and the checks of what is shown."""

import math
from typing import Any

from hypothesis.stateful import RuleBasedStateMachine

from tests.app.document_model import DocumentModel
from tests.browser.board_hand import Point
from tests.browser.board_window import Window
from tests.browser.conftest import REST, Sheet
from tests.patience import wait_until

SLACK_PX = 1.5
"""The tolerance of a position (px), since a mouse stands on whole pixels."""

SAME_M = 1e-6


class TwoWindows(RuleBasedStateMachine):
    """A state machine with the document's last known state, and the model of its history."""

    def __init__(self, pages: tuple[Window, Window], sheet: Sheet) -> None:
        super().__init__()
        self.windows, self.sheet = pages, sheet
        self.model = DocumentModel()
        self.state = sheet.state

    @property
    def outline(self) -> list[Point]:
        return [tuple(corner["point"]) for corner in self.state["drawing"]["outline"]]

    @property
    def folds(self) -> list[dict[str, Any]]:
        folds: list[dict[str, Any]] = self.state["drawing"]["folds"]
        return folds

    def hand(self, who: int) -> Window:
        """Return a window that shows the latest version."""
        self.windows[who].look_at(self.state["version"])
        return self.windows[who]

    def target(self, which: int, pull: tuple[int, int]) -> tuple[int, Point]:
        index = which % len(self.outline)
        x, y = self.outline[index]
        return index, (x + 0.01 * pull[0], y + 0.01 * pull[1])

    def grasp(self, who: int, which: int, pull: tuple[int, int]) -> tuple[Window, int, Point]:
        """Drag a corner, and wait until the server has it there; the button stays down."""
        index, target = self.target(which, pull)
        window = self.hand(who)
        window.begin_drag(self.outline[index], target)
        drawn = window.seen()["outline"][index]
        wait_until(lambda: math.dist(self.sheet.drawing["outline"][index]["point"], drawn) < SAME_M)
        assert self.sheet.state["gesture"] == "Move vertex"
        return window, index, target

    def assert_moved(self, window: Window, index: int, target: Point) -> None:
        assert math.dist(self.outline[index], target) < SLACK_PX * window.pixel_m()

    def go(self, verb: str, who: int | None, label: str | None) -> None:
        """Undo or redo a step, if there is one."""
        if who is None:
            self.state = REST.post(f"{self.sheet.path}/{verb}").raise_for_status().json()
        elif label is not None:
            self.hand(who).press(verb.capitalize())
            version = self.state["version"]
            wait_until(lambda: self.sheet.state["version"] > version)
            self.state = self.sheet.state

    def done(self, label: str) -> None:
        """Wait for a step of this name, and take over the state it led to."""
        version, before = self.state["version"], self.state["drawing"]
        wait_until(lambda: self.is_done(self.sheet.state, version, label))
        self.state = self.sheet.state
        self.model.drop_gesture(before)
        self.model.step(label, before, self.state["drawing"])

    def is_done(self, state: dict[str, Any], version: int, label: str) -> bool:
        return bool(state["version"] > version and state["gesture"] is None and state["history"]["can_undo"] == label)

    def none_done(self) -> None:
        """Wait until the state is as it was."""
        wanted = self.state["drawing"]
        wait_until(lambda: self.sheet.state["gesture"] is None and self.sheet.drawing == wanted)
        self.state = self.sheet.state

    def new_title(self) -> str:
        """Return a title that the document has not had."""
        return f"Cloth {self.sheet.state['version']}"

    def planned(self, state: dict[str, Any]) -> dict[str, Any]:
        """Return the planner's answer to the drawing, independent of the document."""
        if state["problems"]:
            return {"status": "illegal", "primitives": []}
        drawing = state["drawing"]
        asked = {name: drawing[name] for name in ("scene", "start_station", "comfort_radius_m")}
        address = f"{self.sheet.path.partition('/api/')[0]}/api/plans"
        answer = REST.post(address, json={"garment": state["garment"], **asked})
        plan: dict[str, Any] = answer.raise_for_status().json()
        return plan


def assert_shown(shown: dict[str, Any], state: dict[str, Any]) -> None:
    """Check that a window shows the document as the server has it."""
    drawing, history = state["drawing"], state["history"]
    assert shown["versions"] == [state["version"]] * 2
    assert shown["title"] == drawing["title"]
    assert len(shown["outline"]) == len(drawing["outline"])
    for seen, corner in zip(shown["outline"], drawing["outline"], strict=True):
        assert math.dist(seen, corner["point"]) < SAME_M
    assert shown["names"] == [fold["name"] or f"fold {number + 1}" for number, fold in enumerate(drawing["folds"])]
    assert shown["kinds"] == [fold["kind"] for fold in drawing["folds"]]
    for line, fold in zip(shown["lines"], drawing["folds"], strict=True):
        for seen, end in zip(line, (fold["start"], fold["end"]), strict=True):
            assert math.dist(seen, end["point"]) < 0.1 * shown["pixel_m"]  # paths are written to a tenth of a pixel
    for name, keys in (("undo", "Ctrl+Z"), ("redo", "Ctrl+Shift+Z")):
        label = history[f"can_{name}"]
        assert shown[name] == (f"{name.capitalize()}: {label} ({keys})" if label else f"Nothing to {name}")


def beginning(plan: dict[str, Any]) -> str:
    """Return how the status begins."""
    if plan["status"] != "solved":
        return "No plan: "
    if plan["dag"]["folds"] == 0:
        return "No folds yet: draw the first one"
    count = len(plan["primitives"])
    return f"Planned: {count} step{'' if count == 1 else 's'}, {plan['cost_s']:.1f} s"
