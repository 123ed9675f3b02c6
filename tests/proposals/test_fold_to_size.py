"""The benchmark of proposals: its outlines and its table. No time is ever judged."""

from pathlib import Path

import pytest

from bench.fold_to_size import OUTLINES, fold_to_size
from planner.cloth.garment import Garment
from planner.proposals.target import Target, is_fitting


def test_outlines_are_garments_that_are_larger_than_their_targets() -> None:
    assert len(OUTLINES) == 20
    for name, (to, outline) in OUTLINES.items():
        x0, y0, x1, y1 = Garment.from_dict({"name": name, "outline": [list(point) for point in outline]}).pattern.bounds
        target = Target.of(to)
        assert not is_fitting((x1 - x0, y1 - y0), (target.width, target.length)), name


@pytest.mark.long
def test_proposals_are_timed_with_and_without_a_robot(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("bench.fold_to_size.ROBOTS", ("pr2",))
    report = fold_to_size(["hand-towel"], 1)
    assert report.write(tmp_path).is_file()
    (row,) = report.rows
    first_s, third_s = row.data["planned_s"]["pr2"]
    assert 0.0 < row.data["first_s"] <= row.data["three_s"]
    assert 0.0 < first_s <= third_s
    # The towel's own folds, a half and two thirds, are among those that are proposed.
    assert row.data["quickest_s"] <= row.data["own_s"]
    assert row.lines[0][:2] == ("hand-towel", "shelf")
