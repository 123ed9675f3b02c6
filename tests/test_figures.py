"""The figures of docs/model.md: up to date with the planner, and showing what the text says."""

import xml.etree.ElementTree as ET
from functools import cache
from itertools import pairwise

import pytest

from docs.figures.draw import FIGURES, FOLDER

SVG = "{http://www.w3.org/2000/svg}"


@cache
def drawn(name: str) -> str:
    return FIGURES[name]().to_svg()


def marks(name: str, kind: str) -> list[ET.Element]:
    """Return the marks of a class in a figure."""
    return [e for e in ET.fromstring(drawn(name)).iter() if kind in e.get("class", "").split()]


def words(name: str) -> str:
    return " ".join(e.text or "" for e in ET.fromstring(drawn(name)).iter(f"{SVG}text"))


def points(mark: ET.Element) -> list[tuple[float, float]]:
    """Return a line's corners on the sheet (px)."""
    return [(float(x), float(y)) for x, y in (pair.split(",") for pair in mark.get("points", "").split())]


def centre(mark: ET.Element) -> tuple[float, float]:
    return (float(mark.get("cx", "nan")), float(mark.get("cy", "nan")))


def test_every_figure_is_there_and_no_other() -> None:
    assert {path.stem for path in FOLDER.glob("*.svg")} == set(FIGURES)


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_is_what_the_planner_draws_today(name: str) -> None:
    assert (FOLDER / f"{name}.svg").read_text(encoding="utf-8") == drawn(name), "run `make figures`"


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_has_a_ground_of_its_own_and_a_title(name: str) -> None:
    svg = ET.fromstring(drawn(name))
    ground = svg.find(f"{SVG}rect")
    assert ground is not None and (ground.get("width"), ground.get("height")) == (svg.get("width"), svg.get("height"))
    title = svg.find(f"{SVG}title")
    assert title is not None and title.text


def test_the_sleeve_has_two_vertices_to_hold_and_the_hanging_shoulders_four() -> None:
    # The sleeve's outer two, with one grip; none of the bottom's; both sleeves' upper and lower corner.
    assert len(marks("must-hold", "must-hold")) == 2 + 0 + 4
    assert len(marks("must-hold", "grip")) == len(marks("must-hold", "grip-radius")) == 1
    # Two corners each that hang straight below cloth.
    assert len(marks("must-hold", "supported")) == len(marks("must-hold", "into-cloth")) == 2 + 2


def test_the_path_goes_up_to_the_apex_over_the_line_and_down() -> None:
    way, beside = (points(mark) for mark in marks("fold-path", "path"))
    line = points(marks("fold-path", "fold-line")[0])
    top = min(way, key=lambda p: p[1])
    assert top[0] == pytest.approx(line[0][0], abs=0.2)
    # At 430 px/m: the grip is 0.3 m from the line before and after, and as high above its rest at the apex.
    assert (way[0][0] - top[0], top[0] - way[-1][0]) == pytest.approx((129.0, 129.0), abs=0.3)
    assert way[0][1] - top[1] == pytest.approx(129.0, abs=0.3)
    # The hanging one first goes straight up, by 2 x 0.15 m less 2 x 0.02 m, over which it comes in.
    straight = [p for p in beside if abs(p[0] - beside[0][0]) < 0.2]
    assert straight[0][1] - straight[-1][1] == pytest.approx(0.26 * 430.0, abs=2.0)


def test_waypoints_lie_on_the_path_and_no_further_apart_than_five_centimetres() -> None:
    dots = [centre(mark) for mark in marks("fold-path", "waypoint")]
    first = [dot for dot in dots if dot[0] < 450.0]
    gaps = [((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5 for a, b in pairwise(first)]
    assert max(gaps) <= 0.05 * 430.0 + 0.3


def test_the_t_shirts_dag_has_the_edges_of_the_paper() -> None:
    kinds = {mark.get("class") for mark in marks("t-shirt-dag", "edge")}
    assert kinds == {f"edge edge-{a}-{b}" for a, b in ((0, 2), (1, 3), (2, 4), (3, 4))}
    assert len(marks("t-shirt-dag", "fold-line")) == 5


def test_the_limit_of_a_strip_is_friction_over_one_more_than_friction() -> None:
    # 80 px a unit of friction from x = 500 on, 250 px for all of the strip from y = 330 up.
    (limit,) = marks("slip-limit", "limit")
    assert len(points(limit)) > 20
    for x, y in points(limit):
        friction, share = (x - 500.0) / 80.0, (330.0 - y) / 250.0
        assert share == pytest.approx(friction / (1.0 + friction), abs=1e-3)
    assert "μ = 0.5: 33%" in words("slip-limit") and "μ = 1: 50%" in words("slip-limit")


def test_the_pulls_at_right_angles_add_up_as_vectors() -> None:
    # 0.2 m wide, 0.3 and 0.4 m hanging: 0.06 and 0.08 m2, together 0.1. On the table lie 0.6 m of one arm and,
    # of the other, 0.49 - 0.1 m more: 0.198 m2. 0.1 / 0.198 = 0.505.
    assert "net pull 0.10 m², lying 0.198 m²: it stays from μ = 0.505 on" in words("slip-limit")
    one, other, net = (tuple(b - a for a, b in zip(*points(mark), strict=True)) for mark in marks("slip-limit", "pull"))
    assert net == pytest.approx([a + b for a, b in zip(one, other, strict=True)], abs=0.3)


def test_the_big_towel_is_held_out_and_brought_back() -> None:
    # By 0.4 m from 0.05 m inside the edge: 0.4 - 0.05 = 0.35 m beyond it. One layer, one, and two; a drag goes
    # straight, a fold by way of its apex.
    assert "let go, 0.35 m would hang" in words("hanging")
    assert len(marks("hanging", "table")) == 3
    assert len(marks("hanging", "layer")) == 1 + 1 + 2
    assert [len(points(mark)) for mark in marks("hanging", "way")] == [2, 3]


def test_the_model_shows_every_figure() -> None:
    text = (FOLDER.parent / "model.md").read_text(encoding="utf-8")
    for name in FIGURES:
        assert f"](figures/{name}.svg)" in text
