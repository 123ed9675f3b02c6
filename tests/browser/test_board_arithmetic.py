"""Lengths as people write them, and the plane geometry of the page, asked of the modules themselves."""

from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from tests.app.conftest import Served
from tests.browser.board_desk import window


@pytest.fixture(scope="module")
def page(chromium: Browser, designer: Served) -> Iterator[Page]:
    with window(chromium) as page:
        page.goto(f"{designer.url}/static/icon.svg")  # of the same origin, and nothing runs in it
        yield page


def asked(page: Page, module: str, question: str) -> Any:
    """What an expression on a module's exports, called `m`, comes to."""
    return page.evaluate(f"import('/static/js/board/{module}.js').then((m) => {question})")


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
    ],
)
def test_lengths_are_read_as_centimetres_unless_they_say_otherwise(page: Page, text: str, metres: float) -> None:
    assert asked(page, "units", f"m.parsed({text!r})") == pytest.approx(metres, abs=1e-12)


@pytest.mark.parametrize("text", ["", "wide", "3/0", "1e5", "(2", "2)", "3 4", "*2", "18 ft"])
def test_what_is_no_length_is_none(page: Page, text: str) -> None:
    assert asked(page, "units", f"m.parsed({text!r})") is None


def test_what_lies_left_of_a_line_is_cut_off(page: Page) -> None:
    square = [[0, 0], [2, 0], [2, 2], [0, 2]]
    # Upwards along x = 0.5: the left is the strip from 0 to 0.5.
    part = asked(page, "geometry", f"m.leftPart({square}, [0.5, 0], [0.5, 1])")
    assert sorted(part) == [[0, 0], [0, 2], [0.5, 0], [0.5, 2]]


def test_a_point_mirrored_twice_is_where_it_was(page: Page) -> None:
    once = asked(page, "geometry", "m.mirrored([3, 1], [0, 0], [1, 1])")
    assert once == pytest.approx([1, 3])
    assert asked(page, "geometry", f"m.mirrored({once}, [0, 0], [1, 1])") == pytest.approx([3, 1])


def test_the_chord_of_a_notched_cloth_is_the_one_that_is_meant(page: Page) -> None:
    # A square of 3 with a notch from x = 1 to 2 down to y = 1: the line y = 2 has a chord on either side of it.
    notched = [[[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]]]
    assert asked(page, "geometry", f"m.chordAlong([2.2, 2], [2.8, 2], {notched})") == [[2, 2], [3, 2]]
    assert asked(page, "geometry", f"m.chordAlong([0.2, 2], [0.8, 2], {notched})") == [[0, 2], [1, 2]]
    assert asked(page, "geometry", f"m.chordAlong([0, 4], [3, 4], {notched})") is None


def test_a_pose_takes_points_out_and_back(page: Page) -> None:
    pose = "{x_m: 1, y_m: 2, yaw_rad: Math.PI / 2}"
    # A quarter turn takes (1, 0) to (0, 1).
    assert asked(page, "geometry", f"m.toOuter({pose}, [1, 0])") == pytest.approx([1, 3])
    assert asked(page, "geometry", f"m.toInner({pose}, [1, 3])") == pytest.approx([1, 0], abs=1e-12)


def test_the_right_half_of_an_outline_becomes_the_mirror_of_the_left(page: Page) -> None:
    points = [[0, 0], [4, 0], [3, 2], [2, 2.5], [0.5, 2]]
    corners = [{"id": f"v{index}", "point": point} for index, point in enumerate(points)]
    outline = page.evaluate(
        """async (outline) => {
          const edits = await import("/static/js/board/edits.js");
          const drawing = { outline };
          edits.mirrorOutline(drawing);
          return drawing.outline;
        }""",
        corners,
    )
    # The axis is x = 2; corners on it stay single.
    assert [corner["point"] for corner in outline] == [[2, 2.5], [0.5, 2], [0, 0], [4, 0], [3.5, 2]]
