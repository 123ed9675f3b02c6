"""Lengths as people write them, and the plane geometry of the modules, tested on the modules themselves."""

import json
import math
from collections.abc import Sequence
from pathlib import Path
from random import Random
from typing import Any

import pytest
from playwright.sync_api import Page

from app.drawing.curve import CURVE_MAX, CURVE_TOLERANCE_M, Curve
from app.drawing.garment_drawing import blank_drawing
from app.drawing.place_crease import NO_CLOTH
from bench.fold_to_size import OUTLINES
from planner import load_garment
from planner.cloth.garment import FIRST_IS_RED
from planner.cloth.outline import EDGE_MIN_M, POINTS_MAX
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from tests.browser.board_hand import SEVEN

HELD_OUT = Path(__file__).resolve().parents[2] / "bench" / "held_out"


def asked(modules: Page, module: str, question: str, room: str = "board") -> Any:
    """Return the value of an expression on a module's exports, named `m`."""
    return modules.evaluate(f"import('/static/js/{room}/{module}.js').then((m) => {question})")


@pytest.mark.parametrize(
    ("text", "metres"),
    [
        ("30", 0.3),
        ("18in", 0.4572),
        ("91.4/2", 0.457),
        ("1.2 m", 1.2),
        ("12,5", 0.125),
        ("(3 + 4) * 2 mm", 0.014),
        ('6"', 0.1524),
        ("-4", -0.04),
        ("10 - 2 - 3", 0.05),
        ("10 - 2 - 3 in", 0.127),
        ("18in/2", 0.2286),
        ("1m - 2in + 3", 1 - 0.0508 + 0.03),
    ],
)
def test_lengths_are_read_as_centimetres_unless_they_say_otherwise(modules: Page, text: str, metres: float) -> None:
    assert asked(modules, "units", f"m.parsed({text!r})") == pytest.approx(metres, abs=1e-12)


@pytest.mark.parametrize("text", ["", "wide", "3/0", "1e5", "(2", "2)", "3 4", "*2", "18 ft", "2in 3", "in/2"])
def test_what_is_no_length_is_none(modules: Page, text: str) -> None:
    assert asked(modules, "units", f"m.parsed({text!r})") is None


def test_what_lies_left_of_a_line_is_cut_off(modules: Page) -> None:
    square = [[0, 0], [2, 0], [2, 2], [0, 2]]
    # Upwards along x = 0.5: the left is the strip from 0 to 0.5.
    part = asked(modules, "geometry", f"m.leftPart({square}, [0.5, 0], [0.5, 1])")
    assert sorted(part) == [[0, 0], [0, 2], [0.5, 0], [0.5, 2]]


def test_a_point_mirrored_twice_is_where_it_was(modules: Page) -> None:
    once = asked(modules, "geometry", "m.mirrored([3, 1], [0, 0], [1, 1])")
    assert once == pytest.approx([1, 3])
    assert asked(modules, "geometry", f"m.mirrored({once}, [0, 0], [1, 1])") == pytest.approx([3, 1])


def test_the_chord_of_a_notched_cloth_is_the_one_that_is_meant(modules: Page) -> None:
    # A square of 3 with a notch from x = 1 to 2 down to y = 1: the line y = 2 has a chord on either side of it.
    notched = [[[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]]]
    assert asked(modules, "geometry", f"m.chordAlong([2.2, 2], [2.8, 2], {notched})") == [[2, 2], [3, 2]]
    assert asked(modules, "geometry", f"m.chordAlong([0.2, 2], [0.8, 2], {notched})") == [[0, 2], [1, 2]]
    assert asked(modules, "geometry", f"m.chordAlong([0, 4], [3, 4], {notched})") is None


def test_a_pose_takes_points_out_and_back(modules: Page) -> None:
    pose = "{x_m: 1, y_m: 2, yaw_rad: Math.PI / 2}"
    # A quarter turn takes (1, 0) to (0, 1).
    assert asked(modules, "geometry", f"m.toOuter({pose}, [1, 0])") == pytest.approx([1, 3])
    assert asked(modules, "geometry", f"m.toInner({pose}, [1, 3])") == pytest.approx([1, 0], abs=1e-12)


def test_the_right_half_of_an_outline_becomes_the_mirror_of_the_left(modules: Page) -> None:
    points = [[0, 0], [4, 0], [3, 2], [2, 2.5], [0.5, 2]]
    corners = [{"id": f"v{index}", "point": point} for index, point in enumerate(points)]
    outline = modules.evaluate(
        """async (outline) => {
          const edits = await import("/static/js/board/mirror.js");
          const drawing = { outline };
          edits.mirrorOutline(drawing);
          return drawing.outline;
        }""",
        corners,
    )
    # The axis is x = 2; corners on it stay single. An image is called like the corner that was nearest to it.
    assert [corner["id"] for corner in outline] == ["v3", "v4", "v0", "v1", "v2"]
    assert [corner["point"] for corner in outline] == [[2, 2.5], [0.5, 2], [0, 0], [4, 0], [3.5, 2]]


def test_folds_are_named_by_where_cloth_comes_from_and_numbered_where_that_is_taken(modules: Page) -> None:
    folds = '[{name: "left side over"}, {name: "left side over 2"}]'
    assert asked(modules, "stroke", f"m.nameOf([0, 0], [0, 1], {folds})") == "left side over 3"
    assert asked(modules, "stroke", f"m.nameOf([0, 1], [0, 0], {folds})") == "right side over"
    assert asked(modules, "stroke", f"m.nameOf([0, 0], [1, 0], {folds})") == "top down"


@pytest.mark.parametrize(
    ("name", "flipped"),
    [("left side over", "right side over"), ("left side over 2", "right side over"), ("left sleeve", "left sleeve")],
)
def test_a_flipped_fold_is_named_anew_unless_somebody_has_named_it(modules: Page, name: str, flipped: str) -> None:
    fold = f'{{name: "{name}", start: {{point: [0, 0]}}, end: {{point: [0, 1]}}}}'
    assert asked(modules, "stroke", f"m.nameFlipped({fold}, [])") == flipped
    assert asked(modules, "stroke", f'm.nameFlipped({fold}, [{{name: "right side over"}}])') == flipped + (
        " 2" if flipped == "right side over" else ""
    )


def over_axis(modules: Page, outline: list[list[float]], point: list[float]) -> Any:
    """Return the image of a point under the reflection over an outline's axis."""
    carried = f"import('/static/js/board/geometry.js').then((g) => g.mirrored({point}, ...m.axisOf({outline})))"
    return asked(modules, "symmetry", carried)


def test_a_garment_of_which_a_corner_is_pulled_away_keeps_its_axis(modules: Page) -> None:
    # Symmetric about x = 2 but for (4.9, -0.3), which was (4, 0); the middle of the box is at 1.95.
    pulled: list[list[float]] = [[0, 0], [4.9, -0.3], [4, 3], [5, 2], [5, 4], [3, 5], [1, 5], [-1, 4], [-1, 2], [0, 3]]
    assert over_axis(modules, pulled, [0, 0]) == pytest.approx([4, 0])


def test_an_axis_may_slant_if_all_corners_say_so(modules: Page) -> None:
    # A kite with its tips on y = x.
    assert over_axis(modules, [[0, 0], [2, 1], [4, 4], [1, 2]], [3, 0]) == pytest.approx([0, 3])


def test_of_two_axes_the_upright_one_is_meant(modules: Page) -> None:
    assert over_axis(modules, [[0, 0], [2, 0], [2, 5], [0, 5]], [0.5, 1]) == pytest.approx([1.5, 1])


def test_a_garment_without_an_axis_is_mirrored_over_the_middle_of_its_box(modules: Page) -> None:
    # No two corners are level with or plumb to each other; x from -1 to 6.
    odd: list[list[float]] = [[0, 0], [5, 1], [6, 4], [2, 7], [-1, 3]]
    assert over_axis(modules, odd, [0, 0]) == pytest.approx([5, 0])


def laid(modules: Page, edge: list[list[float]], onto: list[list[float]], point: list[float]) -> Any:
    """Return the image of a point under the fold that lays an edge on another; None if no fold does."""
    carry = f"import('/static/js/board/geometry.js').then((g) => line && g.mirrored({point}, ...line))"
    return asked(modules, "edge_onto_edge", f"((line) => {carry})(m.layingOnto({edge}, {onto}))")


def test_an_edge_is_laid_on_one_that_meets_it_over_the_corners_bisector(modules: Page) -> None:
    # Along the x axis and up the line y = x: halved at 22.5 degrees, (2, 0) comes to lie on it, 2 from the corner.
    found = laid(modules, [[0, 0], [3, 0]], [[3, 3], [0, 0]], [2, 0])
    assert found == pytest.approx([2**0.5, 2**0.5])


def test_an_edge_is_laid_on_a_parallel_one_over_the_line_midway(modules: Page) -> None:
    assert laid(modules, [[0, 0], [4, 0]], [[3, 1], [1, 1]], [2, 0]) == pytest.approx([2, 1])


def test_an_edge_is_not_laid_beside_another(modules: Page) -> None:
    # Parallel, but one from x = 0 to 1 and the other from x = 2 to 3; and two stretches of one line.
    assert laid(modules, [[0, 0], [1, 0]], [[3, 1], [2, 1]], [0, 0]) is None
    assert laid(modules, [[0, 0], [1, 0]], [[2, 0], [3, 0]], [0, 0]) is None


def test_a_crease_from_a_corner_ends_where_it_lays_edges_on_edges(modules: Page) -> None:
    # From the corner of a square only its diagonal does; from a place that is on no bisector nothing does.
    square = [[[0, 0], [2, 0], [2, 2], [0, 2]]]
    ends = asked(modules, "edge_onto_edge", f"m.endsOnto([0, 0], {square}).map(({{ at }}) => at)")
    assert ends
    assert all(end == pytest.approx([2, 2]) for end in ends)
    assert asked(modules, "edge_onto_edge", f"m.endsOnto([0.7, 0], {square})") == []


@pytest.mark.parametrize(
    ("cost_s", "least_s", "said"),
    [
        (30.0, 6.5, "A faster plan may exist; lower bound 6.5 s."),
        (27.9, 27.8, "A faster plan may exist; lower bound 27.8 s."),
        (27.835, 27.8, "There may be a quicker plan, by 0.04 s at most."),
        (27.801, 27.8009, "There may be a quicker plan, by 0.01 s at most."),
    ],
)
def test_a_plan_that_reads_the_same_as_what_any_takes_is_told_with_the_difference(
    modules: Page, cost_s: float, least_s: float, said: str
) -> None:
    assert asked(modules, "numbers", f"m.quicker({cost_s}, {least_s})", room="dock") == said


def test_an_outline_goes_on_and_ends(modules: Page) -> None:
    triangle, many = [[0, 0], [0.4, 0], [0, 0.3]], [[0.01 * n, 0] for n in range(POINTS_MAX)]
    asks = [
        ("close", triangle, [0, 0.0005]),
        ("close", triangle, triangle[-1]),
        ("taken", triangle, triangle[1]),
        ("taken", triangle[:2], triangle[0]),
        ("put", triangle, [0.2, 0.2]),
        ("put", many[1:], [0, 0.3]),
        ("full", many, [0, 0.3]),
        ("close", many, many[0]),
    ]
    told = asked(modules, "stroke", f"{json.dumps(asks)}.map(([_, points, next]) => m.nextCorner(points, next))")
    assert told == [expected for expected, _, _ in asks]


def strongest(modules: Page, points: list[Point2], scale: float, to: dict[str, Any]) -> Any:
    """Return what a pointer at each of some points (m) snaps to on the board, at a scale (px/m)."""
    return asked(
        modules,
        "snap",
        f"""{json.dumps(points)}.map((at) => new m.Snapper().strongest(
            {{ scale: {scale} }},
            {{ at, isTouch: false, isKeyboard: false, ctrl: false, shift: false }},
            {json.dumps({"points": [], "onlyCloth": True, **to})},
        ))""",
    )


def test_a_pointer_means_the_corner_before_the_fraction_before_the_edge(modules: Page) -> None:
    square = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.4), (0.0, 0.4)]
    points = [
        (0.006, 0.005),  # 7.8 mm from a corner
        (0.205, 0.006),  # 7.8 mm from the middle of an edge
        (0.1379, 0.006),  # 7.6 mm from a third of an edge
        (0.24, 0.0075),  # nothing but the edge within 8 px
        (0.24, 0.0085),
        (0.2, 0.2),
    ]
    found = strongest(modules, points, 1000.0, {"rings": [square]})
    assert [one and one["kind"] for one in found] == ["vertex", "fraction", "fraction", "edge", None, None]
    assert found[0]["at"] == pytest.approx([0, 0])
    assert found[1]["at"] == pytest.approx([0.2, 0])
    assert found[2]["at"] == pytest.approx([0.4 / 3, 0])
    assert found[3]["at"][1] == pytest.approx(0)


@pytest.mark.parametrize("scale", [100.0, 300.0, 800.0, 4000.0])
def test_a_point_is_moved_by_no_more_than_a_centimetre_of_cloth_and_8_px(modules: Page, scale: float) -> None:
    most_m = min(0.01, 8.0 / scale)
    square = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.4), (0.0, 0.4)]
    to = {"rings": [square], "guides": [(0.137, 0.171)], "onlyCloth": False}
    away = [(-0.6, 0.9), (0.0, 1.02), (0.8, 0.7), (0.3, -0.3), (-1.5, 0.2)]
    points = [(x + u * most_m, y + v * most_m) for x, y in [*square, (0.2, 0.0), (0.21, 0.23)] for u, v in away]
    found = strongest(modules, points, scale, to)
    assert any(found)
    for point, one in zip(points, found, strict=True):
        assert one is None or math.dist(point, one["at"]) <= most_m + 1e-9


def test_a_garment_that_is_drawn_is_called_what_its_outline_looks_like(modules: Page) -> None:
    def title(*points: tuple[float, float]) -> Any:
        return asked(modules, "guessed_title", f"m.guessedTitle({[list(point) for point in points]})")

    assert title((0, 0), (0.6, 0), (0.6, 0.9), (0, 0.9)) == "Towel"
    assert title((0, 0), (0.2, 0), (0.2, 1.4), (0, 1.4)) == "Scarf"
    assert title(*SEVEN) == "Vest"
    legs = [(0.0, 0.0), (0.2, 0.0), (0.25, 0.6), (0.3, 0.0), (0.5, 0.0), (0.45, 1.0), (0.05, 1.0)]
    assert title(*legs) == title(*reversed(legs)) == "Trousers"
    disc = [(math.cos(math.pi * n / 12), math.sin(math.pi * n / 12)) for n in range(24)]
    assert title(*disc) == "Round cloth"
    assert title((0, 0), (0.6, 0), (0.3, 0.5)) == ""


def test_no_garment_that_is_drawn_has_a_wrong_name(modules: Page) -> None:
    held_out = {path.stem: load_garment(path).outline for path in HELD_OUT.glob("*.json")}
    shipped = {name: load_garment(name).outline for name in ("jeans", "shirt", "skirt", "t-shirt", "tie", "vest")}
    others = {name: outline for name, (_, outline) in OUTLINES.items()}
    right = {"t-shirt": "T-shirt", "jeans": "Trousers", "leggings": "Trousers", "vest": "Vest"}
    for outlines in (held_out, shipped, others):
        for name, outline in outlines.items():
            (found,) = asked(modules, "guessed_title", f"[m.guessedTitle({[list(point) for point in outline]})]")
            is_sheet = outline_area(outline) > 0.99
            assert found in ("", "Towel", "Scarf") if is_sheet else found == right.get(name, ""), name


def outline_area(outline: Sequence[Point2]) -> float:
    """Return the share of its box that an outline fills."""
    region = Region.polygon(outline)
    x0, y0, x1, y1 = region.bounds
    return region.area / ((x1 - x0) * (y1 - y0))


def test_the_smaller_part_moves_whichever_way_a_fold_is_drawn_and_both_can_be_had(modules: Page) -> None:
    square = [[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]]

    def line(x: float, start: float, end: float, is_flipped: bool = False) -> Any:
        stroke = {"isGrab": False, "from": [x, start], "to": [x, end]}
        return asked(modules, "stroke", f"m.lineOf({json.dumps(stroke)}, {square}, {json.dumps(is_flipped)})")

    up, down = [[0.2, 0.0], [0.2, 1.0]], [[0.2, 1.0], [0.2, 0.0]]
    assert line(0.2, 0.0, 1.0) == line(0.2, 1.0, 0.0) == up
    assert line(0.2, 0.0, 1.0, is_flipped=True) == line(0.2, 1.0, 0.0, is_flipped=True) == down
    assert line(0.5, 1.0, 0.0) == [[0.5, 1.0], [0.5, 0.0]]
    assert line(0.0, 0.0, 1.0) == [[0.0, 0.0], [0.0, 1.0]]


def test_the_page_has_the_numbers_and_sentences_of_the_server(modules: Page) -> None:
    names = ("MOST_CORNERS", "SAME_CORNER_M", "CURVE_TOLERANCE_M", "CURVE_MAX")
    numbers = asked(modules, "rules", f"{json.dumps(names)}.map((name) => m[name])")
    assert numbers == [POINTS_MAX, EDGE_MIN_M, CURVE_TOLERANCE_M, CURVE_MAX]
    assert asked(modules, "rules", "m.UNTITLED") == blank_drawing().title
    sentences = asked(modules, "rules", "[m.NO_CLOTH, m.FIRST_IS_RED]")
    assert [text.lower().rstrip(".") for text in sentences] == [NO_CLOTH.lower(), FIRST_IS_RED.lower()]


def test_an_edge_is_bent_straight_to_a_half_circle_to_an_arc_or_freely(modules: Page) -> None:
    a, b = (0.0, 0.0), (0.4, 0.0)
    points = [(0.1, 0.005), (0.205, 0.195), (0.205, 0.1), (0.3, 0.1)]
    found = strongest(modules, points, 1000.0, {"rings": [], "bent": [a, b]})
    assert [one and one["kind"] for one in found] == ["dropped", "fraction", "bisector", None]
    assert found[0]["at"] == pytest.approx([0.1, 0.0])
    assert found[1]["at"] == pytest.approx([0.2, 0.2])
    assert found[2]["at"] == pytest.approx([0.2, 0.1])


def test_the_page_bends_an_edge_to_a_handle_as_the_server_reads_the_curve(modules: Page) -> None:
    a, b = (0.1, 0.0), (0.4, 0.2)
    rng = Random(74)
    for along, across in [(rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5)) for _ in range(20)]:
        x, y = Curve(along, across).handle(a, b)
        bent = asked(modules, "curves", f"m.curveThrough({list(a)}, {list(b)}, [{x}, {y}])")
        assert bent == pytest.approx({"along": along, "across": across})
    assert asked(modules, "curves", f"m.curveThrough({list(a)}, {list(b)}, [0.25, 0.1])") is None


def test_a_drawing_is_made_as_large_as_the_garment_of_a_suggestion_and_folds_stay_tied(modules: Page) -> None:
    tie = {"kind": "vertex", "vertex": "v0"}
    drawing = {
        "outline": [
            {"id": "v0", "point": [0, 0]},
            {"id": "v1", "point": [0.8, 0], "curve": {"along": 0.0, "across": -0.5}},
            {"id": "v2", "point": [0.8, 0.4]},
        ],
        "folds": [{"start": {"point": [0, 0], "on": tie}, "end": {"point": [0.8, 0.2], "on": None}}],
        "grip_radius_m": 0.127,
    }
    made = modules.evaluate(
        """async (drawing) => {
          const { applyChange } = await import("/static/js/dock/suggestion_button.js");
          const { ringOf } = await import("/static/js/board/curves.js");
          const outline = ringOf(drawing).map(([x, y]) => [x / 2, y / 2]);
          const folds = [{ start: [0, 0], end: [0.4, 0.1], grip_radius_m: 0.127 }];
          applyChange(drawing, { garment: { outline, folds, grip_radius_m: 0.127 } });
          return drawing;
        }""",
        drawing,
    )
    assert [corner["point"] for corner in made["outline"]] == [[0, 0], [0.4, 0], [0.4, 0.2]]
    assert made["outline"][1]["curve"] == {"along": 0.0, "across": -0.5}
    assert made["folds"][0]["start"] == {"point": [0, 0], "on": tie}
    assert made["folds"][0]["end"]["point"] == [0.4, 0.1]


def test_words_of_findings_leave_the_foot_of_the_board_to_its_hint(modules: Page) -> None:
    words = {"key": "a", "tag": "text", "class": "drag-text", "text": "dragged", "text-anchor": "middle", "x": 100}
    for y, expected in ((395, 364), (370, 364), (360, 360), (450, 450)):
        (placed,) = asked(modules, "words_apart", f"m.wordsApart({json.dumps([{**words, 'y': y}])}, 400)")
        assert placed["y"] == expected


def test_figures_of_the_grid_give_way_to_words_written_over_them(modules: Page) -> None:
    figures = [{"key": str(y), "tag": "text", "class": "grid-figure", "text": "20", "x": 4, "y": y} for y in (100, 160)]
    lines = {"key": "fine", "tag": "path", "d": "M0 0"}
    words = {
        "key": "a",
        "tag": "text",
        "class": "drag-text",
        "text": "dragged",
        "text-anchor": "middle",
        "x": 30,
        "y": 103,
    }
    left = asked(modules, "words_apart", f"m.uncovered({json.dumps([lines, *figures])}, {json.dumps([words])})")
    assert left == [lines, figures[1]]


def test_words_of_findings_are_never_written_over_each_other(modules: Page) -> None:
    random = Random(18)
    kinds = ("reason-text", "drag-text", "beyond-text", "robot-name")
    for _ in range(50):
        items = [
            {"key": kind, "tag": "text", "class": kind, "text": kind * 2, "text-anchor": "middle"}
            | {"x": random.uniform(100, 290), "y": random.uniform(250, 300)}
            for kind in kinds
        ]
        items.append({"key": "cross", "tag": "path", "class": "problem", "d": "M0 0"})
        placed = asked(modules, "words_apart", f"m.wordsApart({json.dumps(items)}, 400)")
        assert [{**new, "y": 0} for new in placed] == [{**old, "y": 0} for old in items[:4]] + [{**items[4], "y": 0}]
        assert placed[0]["y"] == items[0]["y"]  # what is missing stays where it is
        for n, one in enumerate(placed[:4]):
            for other in placed[:n]:
                apart_px = abs(one["x"] - other["x"]) - 6.5 * (len(one["text"]) + len(other["text"])) / 2
                assert abs(one["y"] - other["y"]) >= 15 or apart_px >= 0
