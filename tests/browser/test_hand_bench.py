"""The benchmark of response times under the hand: its statistics, and the times that the page records."""

import json
from pathlib import Path
from typing import Any

import pytest

from bench.hand import COLUMNS, drags_of, hand
from bench.hand_page import Heard

# Two frames of 16 ms. The first movement begins no drag; the second is drawn in its frame, as is the third; the fourth
# is drawn in the frame after the next.
KEPT: dict[str, Any] = {
    "moved": [[1.0, 1.5], [5.0, 5.5], [20.0, 20.5], [33.0, 33.5]],
    "released": [70.0],
    "frames": [16.0, 32.0, 48.0, 64.0],
    "drawn": [2.0, 17.0, 33.0, 65.0],
    "told": [[60.0, 7, "solved"], [90.0, 8, "planning"], [190.0, 9, "infeasible"], [191.0, 9, "infeasible"]],
}


def test_a_movement_lasts_until_it_is_drawn_and_a_release_until_its_plan_is_told() -> None:
    heard = Heard.of(KEPT, 9)
    assert heard.to_ghost_ms == (12.0, 13.0, 32.0)
    assert heard.same_frame == (True, True, False)
    assert (heard.to_plan_ms, heard.status) == (120.0, "infeasible")


@pytest.mark.long
def test_a_corner_is_dragged_in_a_browser_and_timed_by_the_page() -> None:
    (dragged,) = drags_of("hand-towel", 1, has_view=False)
    assert len(dragged.to_ghost_ms) >= 3
    assert all(time_ms > 0.0 for time_ms in dragged.to_ghost_ms)
    assert dragged.to_plan_ms > 0.0
    assert dragged.status == "solved"


@pytest.mark.long
def test_without_a_browser_the_table_says_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("bench.hand_page.SYSTEM_CHROMIUM", str(tmp_path / "nothing"))
    report = hand(["hand-towel"], 1)
    ((line,),) = (row.lines for row in report.rows)
    assert line == ("no browser", *["-"] * (len(COLUMNS) - 1))
    (row,) = json.loads(report.write(tmp_path).read_text(encoding="utf-8"))["rows"]
    assert str(tmp_path) in row["missing"]


def test_other_garments_than_the_nine_are_left_out() -> None:
    assert hand(["scarf-halved"], 1).rows == ()
