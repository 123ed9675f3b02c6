"""The instruction sheet: a plan on one page, a numbered picture for each step, and the folded cloth at the end.

Pictures show the table as the robot at its near edge sees it: the far side up. Each has the cloth before its step, the
robot where it stands, where hands take the cloth, and arrows to where they bring it.
"""

import math
import textwrap
from collections.abc import Iterator, Sequence

import numpy as np

from app.files.sheet_page import Disc, Outline, Page, Shape, Spot, Words
from app.language import ENGLISH, Language, named, numeral, say, translated
from app.step_kinds import step_kind
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray, Pose2, point2
from planner.task.plan import Plan, PlanStep
from planner.task.world_state import WorldState

WIDTH, HEIGHT = 595.0, 842.0
"""The page: A4, upright (pt)."""

_MARGIN, _HEAD, _CAPTION, _GAP = 40.0, 46.0, 30.0, 12.0
_CLOTH = {"front": "f0e6d2", "back": "b4c3d6"}
_EDGE, _TABLE, _INK, _FAINT = "5a5142", "f4f4f2", "222222", "888888"
_ROBOT = 11.0
"""Half the width of the robot's base in pictures (pt); to scale it would leave the cloth no room."""

_LETTER, _BOLD_LETTER = 4.5, 5.1
"""Width of a letter of a caption (pt)."""

_LINE = 10.0
"""Height of a line of a caption (pt)."""

_TITLE_LINES = 2
"""Most lines for what a step does; there is room for one more below them."""


def instruction_sheet(plan: Plan, language: Language = ENGLISH) -> Page:
    """Return the page of a solved plan, in a language.

    Raises:
        UnsolvedPlanError: the plan is not solved.
    """
    if not plan.is_solved:
        raise UnsolvedPlanError(plan.status)
    count = len(plan.steps) + 1
    columns = _columns(count)
    rows = math.ceil(count / columns)
    wide, tall = (WIDTH - 2 * _MARGIN + _GAP) / columns, (HEIGHT - 2 * _MARGIN - _HEAD + _GAP) / rows
    frames = [
        (_MARGIN + n % columns * wide, _MARGIN + _HEAD + n // columns * tall, wide - _GAP, tall - _GAP - _CAPTION)
        for n in range(count)
    ]
    shapes: list[Shape] = list(_head(plan, language))
    for number, (step, frame) in enumerate(zip(plan.steps, frames, strict=False), 1):
        shapes += _step(plan, number, step, frame, language)
    shapes += _done(plan, frames[-1], language)
    return Page(
        WIDTH, HEIGHT, say(language, "sheet.title", title=translated(language, plan.garment.title)), tuple(shapes)
    )


Frame = tuple[float, float, float, float]
"""Left, top, width and height of a picture (pt)."""


def _columns(count: int) -> int:
    """Return the number of columns in which pictures are largest."""
    room = WIDTH / (HEIGHT - _HEAD)
    return max(2, math.ceil(math.sqrt(count * room)))


def _head(plan: Plan, language: Language) -> Iterator[Shape]:
    title = translated(language, plan.garment.title)[:60]
    yield Words((_MARGIN, _MARGIN + 14), title, 18, is_bold=True)
    steps = say(language, "status.steps", count=len(plan.steps))
    about = f"{steps}, {_seconds(language, plan.cost_s or 0.0)}. {say(language, 'sheet.near_edge')}"
    yield Words((_MARGIN, _MARGIN + 30), about, 9)


def _seconds(language: Language, time_s: float) -> str:
    return say(language, "time.seconds", number=numeral(language, time_s))


def _step(plan: Plan, number: int, step: PlanStep, frame: Frame, language: Language) -> Iterator[Shape]:
    grips = np.array([point[:2] for grip in step.grips for point in (grip.pick, grip.place)]).reshape(-1, 2)
    kind = step_kind(step.kind)
    stands = _waypoints(step) if kind.moves == "base" else [step.base.pose]
    bases = np.array([[pose.x_m, pose.y_m] for pose in stands])
    seen = [_spread(plan, step.before), grips, *([bases] if kind.moves == "base" else [])]
    view = _View(frame, np.concatenate(seen))
    yield from _ground(plan, view, frame)
    yield from _cloth(plan, step.before, view)
    yield from _robot(step.base.pose, view, frame)
    if kind.moves == "base":
        yield from _arrow([view.spot(row) for row in bases])
    for grip in step.grips:
        pick, place = view.spot(np.array(grip.pick[:2])), view.spot(np.array(grip.place[:2]))
        yield from _arrow(_bent(pick, place) if kind.moves == "part" else [pick, place])
        yield Disc(pick, 6.5)
        yield Words((pick[0], pick[1] + 3), grip.arm[:1].upper(), 8, is_bold=True, anchor="middle")
    yield from _caption(number, frame, named(language, "kind", step.kind), _about(plan, step, language))


def _done(plan: Plan, frame: Frame, language: Language) -> Iterator[Shape]:
    view = _View(frame, _spread(plan, plan.end))
    yield from _ground(plan, view, frame)
    yield from _cloth(plan, plan.end, view)
    after = say(language, "sheet.after", time=_seconds(language, plan.cost_s or 0.0))
    yield from _caption(len(plan.steps) + 1, frame, say(language, "sheet.done"), (after,))


class _View:
    """The projection from the table frame into a picture."""

    def __init__(self, frame: Frame, seen: FloatArray) -> None:
        """Show all of some points, shape (n, 2), m."""
        left, top, width, height = frame
        low, high = seen.min(axis=0), seen.max(axis=0)
        deep, wide = np.maximum(high - low, 0.1) + 0.16
        self.scale = float(min(width / wide, height / deep))
        self._middle = (low + high) / 2
        self._at = (left + width / 2, top + height / 2)

    def spot(self, point: FloatArray) -> Spot:
        """Return the place of a point."""
        ahead, aside = point - self._middle
        return (float(self._at[0] - aside * self.scale), float(self._at[1] - ahead * self.scale))

    def spots(self, points: FloatArray) -> tuple[Spot, ...]:
        """Return the places of points, shape (n, 2)."""
        return tuple(self.spot(point) for point in points)


def _spread(plan: Plan, world: WorldState) -> FloatArray:
    """Return the corners of the cloth, table frame, shape (n, 2)."""
    layers = plan.sequence.cloth(world.done).layers
    return np.concatenate([world.placement.to_outer(layer.ring) for layer in layers])


def _ground(plan: Plan, view: _View, frame: Frame) -> Iterator[Shape]:
    """Draw what of the table is in the picture, and the picture's frame."""
    left, top, width, height = frame
    x, y = plan.scene.table.depth_m / 2, plan.scene.table.width_m / 2
    inside = [
        (min(max(u, left), left + width), min(max(v, top), top + height))
        for u, v in view.spots(np.array([(-x, -y), (x, -y), (x, y), (-x, y)]))
    ]
    yield Outline(tuple(inside), _TABLE, _FAINT, 0.5)
    corners = ((left, top), (left + width, top), (left + width, top + height), (left, top + height), (left, top))
    yield Outline(corners, stroke="cccccc", width=0.5)


def _cloth(plan: Plan, world: WorldState, view: _View) -> Iterator[Shape]:
    for layer in plan.sequence.cloth(world.done).layers:
        yield Outline(view.spots(world.placement.to_outer(layer.ring)), _CLOTH[layer.face], _EDGE, 0.6)


def _robot(base: Pose2, view: _View, frame: Frame) -> Iterator[Shape]:
    """Draw the robot where it stands, or at the edge of the picture towards where it stands."""
    left, top, width, height = frame
    x, y = view.spot(np.array([base.x_m, base.y_m]))
    at = np.array([min(max(x, left + _ROBOT), left + width - _ROBOT), min(max(y, top + _ROBOT), top + height - _ROBOT)])
    ahead = np.array([-math.sin(base.yaw_rad), -math.cos(base.yaw_rad)]) * _ROBOT
    aside = np.array([ahead[1], -ahead[0]])
    ring = [at + u * ahead + v * aside for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    arms = [(at + 0.2 * ahead + v * aside, at + 1.7 * ahead + 0.6 * v * aside) for v in (0.7, -0.7)]
    for shoulder, hand in arms:
        yield Outline((point2(shoulder), point2(hand)), stroke=_FAINT, width=2.4)
    yield Outline(tuple(point2(corner) for corner in ring), "ffffff", _FAINT, 1.0)
    yield Disc(point2(at + 0.15 * ahead), 0.36 * _ROBOT, "ffffff", _FAINT)


def _waypoints(step: PlanStep) -> list[Pose2]:
    return [step.before.base.pose, *(Pose2(*pose) for pose in step.details.get("waypoints", ())), step.base.pose]


def _bent(start: Spot, end: Spot) -> list[Spot]:
    """Return an arc from one place to another: the hand goes over the cloth, not along it."""
    (x0, y0), (x1, y1) = start, end
    dx, dy = x1 - x0, y1 - y0
    bends = [(share, 0.72 * share * (1 - share)) for share in (n / 12 for n in range(13))]
    return [(x0 + s * dx + bend * dy, y0 + s * dy - bend * dx) for s, bend in bends]


def _arrow(way: Sequence[Spot]) -> Iterator[Shape]:
    """Draw a way with a head at its end; none where it is too short to be seen."""
    (x0, y0), (x1, y1) = way[-2], way[-1]
    if math.dist(way[0], way[-1]) < 4:
        return
    turn = math.atan2(y1 - y0, x1 - x0)
    barbs = [(x1 - 7 * math.cos(turn + side), y1 - 7 * math.sin(turn + side)) for side in (0.45, -0.45)]
    yield Outline(tuple(way), stroke=_INK, width=1.4)
    yield Outline(((x1, y1), *barbs), _INK, _INK, 0.6)


def _about(plan: Plan, step: PlanStep, language: Language) -> tuple[str, ...]:
    """Return the lines below a picture: what is done; by which hands, from where, how long."""
    hands = " + ".join(sorted(grip.arm[:1].upper() for grip in step.grips))
    kind = step_kind(step.kind)
    station = None if kind.moves == "base" else step.base.station
    where = "" if station is None else say(language, "sheet.at", place=named(language, "station", station))
    details = ", ".join(part for part in (hands, where, _seconds(language, step.duration_s)) if part)
    return (kind.on_sheet(step.details, plan.garment, language), details)


def _caption(number: int, frame: Frame, kind: str, lines: Sequence[str]) -> Iterator[Shape]:
    left, top, width, height = frame
    room, below = width - 22, top + height
    yield Disc((left + 9, below + 13), 8)
    yield Words((left + 9, below + 16), str(number), 8, is_bold=True, anchor="middle")
    first, *rest = lines
    titles = textwrap.wrap(
        f"{kind}: {first}" if rest else kind,
        max(int(room / _BOLD_LETTER), 8),
        max_lines=_TITLE_LINES,
        placeholder="\N{HORIZONTAL ELLIPSIS}",
    )
    for line, title in enumerate(titles):
        yield Words((left + 22, below + 11 + line * _LINE), title, 8, is_bold=True)
    details = (rest[0] if rest else first)[: max(int(room / _LETTER), 8)]
    yield Words((left + 22, below + 11 + len(titles) * _LINE), details, 8)
