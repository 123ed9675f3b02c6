"""The tables that the command line prints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from rich import box
from rich.table import Column, Table

from planner.words.catalogue import sentence

if TYPE_CHECKING:  # the tables of a command need not import what the others show
    from app.comparison import Comparison
    from planner.cloth.garment import Garment
    from planner.explain.garment_check import FoldCheck, GarmentCheck
    from planner.explain.suggestion import Suggestion
    from planner.geometry.pose import Point2
    from planner.proposals.proposals import Proposals
    from planner.robots.card_file import CardFile
    from planner.robots.table_reach import TableReach
    from planner.task.plan import Plan, PlanStep

_POINTS_SHOWN = 4
"""Number of points printed before the rest is only counted."""

_SUPPORTS = {
    "hangs_freely": "must be held, hanging freely: nothing above",
    "on_the_line": "need not, on the fold line",
    "cloth_above": "need not, held by the cloth above",
    "cloth_nearly_above": "need not, held by the cloth nearly straight above",
    "within_the_hull": "need not, held by the cloth on both sides: no corner of the convex hull",
}
"""Each `planner.explain.garment_check.Support` in words, those for corners that must be held first."""

_WHY = (
    '"Above" leads away from the fold line: so the part hangs while it is folded. A corner of its convex hull must be '
    "held unless it is on the line or going up from it leads into the cloth."
)


def plan_table(plan: Plan) -> Table:
    """Return a solved plan as a table, one row for each primitive."""
    count = len(plan.primitives)
    title = f"{plan.garment.title}: {count} primitive{'' if count == 1 else 's'}, {plan.cost_s:.2f} s"
    table = _table(title, "primitive", "what", _right("start\n[s]"), _right("duration\n[s]"), "base")
    table.add_column("grips [m]", no_wrap=True)
    for primitive in plan.steps:
        data = primitive.to_dict()
        table.add_row(
            data["kind"],
            _what(primitive, plan.garment),
            f"{data['start_s']:.2f}",
            f"{data['duration_s']:.2f}",
            _base(data["base"]),
            "\n".join(_grip(grip) for grip in data["grips"]),
        )
    return table


def dag_table(garment: Garment, edges: Sequence[Sequence[int]]) -> Table:
    """Return the Fold-DAG as a table: each fold, and the folds that must precede it."""
    table = _table(f"{garment.title}: {len(garment.folds)} folds", _right("fold"), "name", "kind", "waits for")
    for index, fold in enumerate(garment.folds):
        before = ", ".join(str(first) for first, then in edges if then == index)
        table.add_row(str(index), fold.name, fold.kind, before or "-")
    return table


def robots_table(cards: Sequence[CardFile]) -> Table:
    """Return robots as a table."""
    table = _table(f"{len(cards)} robots", "name", "title", "arms", "joints", "base")
    for card in cards:
        arms, joints = ", ".join(arm.name for arm in card.arms), ", ".join(str(len(arm.joints)) for arm in card.arms)
        table.add_row(card.name, card.title, arms, joints, card.base.kind)
    return table


def robot_check_table(card: CardFile, reach: TableReach) -> Table:
    """Return a card that is complete as a table: each arm, and how much of the table is in its reach."""
    title = f"{card.title}: a good card, all that it names is there"
    table = _table(title, "arm", _right("joints"), "tool", _right("reaches of the table"))
    for arm in card.arms:
        table.add_row(arm.name, str(len(arm.joints)), arm.tool.link, f"{reach.arms[arm.name]:.0%}")
    table.add_row("any", "", "", f"{reach.any_arm:.0%}")
    if len(card.arms) > 1:
        table.add_row("two at once", "", "", f"{reach.two_arms:.0%}")
    return table


def comparison_table(found: Sequence[Comparison]) -> Table:
    """Return who can fold a garment as a table: for each robot how long it takes, with what margin, or what helps."""
    title = f"{found[0].plan.garment.title}: who can fold it" if found else ""
    numbers = _right("cost [s]"), _right("margin [mm]")
    table = _table(title, "robot", "folds it", *numbers, "why not, and what it would take")
    for one in found:
        folds, plan = one.plan.garment.folds, one.plan
        causes = sorted(plan.reasons, key=lambda reason: reason.code == "waits_for_fold")
        sentences = [sentence(reason.says, folds, reason.fold) for reason in causes[:1]]
        if one.is_cut_short and not plan.is_solved:
            sentences.append(
                f"the time limit of {plan.task.limits.time_limit_s:g} s, or as much work, ran out before more was tried"
            )
        sentences += [] if one.help is None else [f"{sentence(one.help.says, folds)}: {one.help.cost_s:.1f} s"]
        cost = "" if plan.cost_s is None else f"{plan.cost_s:.2f}"
        margin = "" if one.margin_m is None else f"{1000.0 * one.margin_m:.0f}"
        answer = {"solved": "yes", "infeasible": "no"}.get(plan.status, "not known")
        table.add_row(one.robot, answer, cost, margin, "; ".join(sentences))
    return table


def check_table(garment: Garment, report: GarmentCheck) -> Table:
    """Return for each fold the number of grippers it needs, and the corners that must be held, with the reasons."""
    width, height = report.size_m
    title = (
        f"{garment.title}: a good file, {len(report.folds)} legal fold{'' if len(report.folds) == 1 else 's'}; "
        f"outline of {report.points} points, {width:.3f} x {height:.3f} m, {report.area_m2:.3f} m2"
    )
    corners = "corners of the part that moves [m]"
    table = _table(title, _right("fold"), "name", "kind", _right("grippers"), corners)
    table.caption, table.caption_justify = _WHY, "left"
    for index, fold in enumerate(report.folds):
        needed = "too many" if fold.grips_needed is None else str(fold.grips_needed)
        lines = [*_corners(fold), _held_at(fold, garment, index)]
        table.add_row(str(index), fold.name, fold.kind, needed, "\n".join(lines), end_section=True)
    return table


def _corners(fold: FoldCheck) -> Iterator[str]:
    """Yield the corners that must be held, then those that need not, each group with its reason."""
    for support, why in _SUPPORTS.items():
        points = [vertex.point for vertex in fold.vertices if vertex.support == support]
        if points:
            yield f"{_points(points)}: {why}"


def _held_at(fold: FoldCheck, garment: Garment, index: int) -> str:
    """Return where the hands grip, or what prevents it."""
    if fold.reason is not None:
        return sentence(fold.reason.says, garment.folds, index)
    if not fold.grips:
        return "nothing must be held"
    return f"held at {_points(fold.grips)}: a grip holds what is within {garment.folds[index].grip_radius_m:g} m"


def proposals_table(garment: Garment, found: Proposals) -> Table:
    """Return ways to fold a garment to a size, the quickest first."""
    kept, number = len(garment.folds), len(found.proposals)
    title = f"{garment.title}: {number} proposal{'' if number == 1 else 's'}, of {found.tried.enumerated} ways tried"
    table = _table(title, "folds", _right("size [m]"), _right("layers"), "face", _right("seconds"), "status")
    for one in found.proposals:
        names = [fold.name for fold in one.garment.folds[kept:]]
        width_m, length_m = one.size_m
        reasons = () if one.plan is None else one.plan.reasons[:1]
        status = f"{one.status}, with loose grips" if one.is_loose else one.status
        table.add_row(
            ", ".join([*([f"{kept} kept"] if kept else []), *names]),
            f"{width_m:.3f} x {length_m:.3f}",
            str(one.layers),
            one.face,
            "" if one.cost_s is None else f"{one.cost_s:.2f}",
            ": ".join([status, *(sentence(why.says, one.garment.folds, why.fold) for why in reasons)]),
        )
    return table


def suggestion_table(garment: Garment, found: Sequence[Suggestion]) -> Table:
    """Return the changes that would give a plan, or a quicker one; those a person can make come before assumptions."""
    title = f"{garment.title}: {len(found)} suggestion{'' if len(found) == 1 else 's'}"
    table = _table(title, "kind", "what", _right("size"), _right("cost [s]"), "assumption?")
    for one in sorted(found, key=lambda one: one.is_assumption):
        is_so = "yes" if one.is_assumption else "no"
        table.add_row(
            one.kind.replace("_", " "), sentence(one.says, garment.folds), f"{one.size:.3g}", f"{one.cost_s:.2f}", is_so
        )
    return table


def _table(title: str, *columns: str | Column) -> Table:
    look: dict[str, Any] = {"header_style": "bold", "box": box.SIMPLE_HEAD, "padding": (0, 1, 0, 0)}
    return Table(*columns, title=title, title_justify="left", **look)


def _right(name: str) -> Column:
    """Return the column of numbers."""
    return Column(name, justify="right")


def _what(step: PlanStep, garment: Garment) -> str:
    from app.step_kinds import step_words

    words = step_words(step, garment)
    return words if step.fold is None else f"{step.fold}: {words}"


def _base(base: dict[str, Any]) -> str:
    return (
        f"{base['station']}, {base['back_off_m']:.2f} m back"
        if base["station"]
        else f"({base['x_m']:.2f}, {base['y_m']:.2f})"
    )


def _grip(grip: dict[str, Any]) -> str:
    """Return an arm, and its tool's positions at pick and place in the plane of the table (m)."""
    (x, y, _), (to_x, to_y, _) = grip["pick"], grip["place"]
    return f"{grip['arm']} ({x:.3f}, {y:.3f})\nto ({to_x:.3f}, {to_y:.3f})"


def _points(points: Sequence[Point2]) -> str:
    """Return the first few points (m), and the number of the others."""
    shown = " ".join(f"({x:.3f}, {y:.3f})" for x, y in points[:_POINTS_SHOWN])
    more = len(points) - _POINTS_SHOWN
    return f"{shown} and {more} more" if more > 0 else shown
