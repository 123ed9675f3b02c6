"""The T-shirt's Fold-DAG: each fold on the cloth as it is when all that the fold waits for has been done."""

from docs.figures.drawing import BACK, BLUE, EDGE, FRONT, INK, Drawing, Style, View
from planner.cloth.garment_files import load_garment
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2

_SCALE = 210.0
_MIDDLE = (0.2285, 0.305)
_COLUMN_PX, _FIRST_PX = 300.0, 150.0
_HEIGHT_PX = 412
_HALF_WIDTH_PX = 98.0


def draw() -> Drawing:
    """Folds that wait for nothing at the left; arrows from each fold to those that wait for it."""
    sheet = Drawing(
        900, _HEIGHT_PX, "The Fold-DAG of the T-shirt: sides wait for their sleeves, the bottom for both sides"
    )
    sequence = FoldSequence.of(load_garment("t-shirt"))
    edges = sequence.dag.edges
    places = _places(len(sequence.folds), edges)
    for a, b in edges:
        (ax, ay), (bx, by) = places[a], places[b]
        flat = sheet.view((0.0, 0.0), 1.0)
        ends = ((ax + _HALF_WIDTH_PX, -ay), (bx - _HALF_WIDTH_PX, -by))
        flat.line(f"edge edge-{a}-{b}", ends, Style(INK, width=2.0), arrow=True)
    for index, place in places.items():
        _fold(sheet.view(place, _SCALE, _MIDDLE), sequence, index, _before(index, edges))
        words = f"{index}  {sequence.folds[index].name}"
        sheet.text((place[0], place[1] + 86), words, anchor="middle", bold=True)
    sheet.text(
        (870, _HEIGHT_PX - 14), "blue: the fold line; grey: what it moves; dashed: where that lands", anchor="end"
    )
    return sheet


def _places(count: int, edges: tuple[tuple[int, int], ...]) -> dict[int, Point2]:
    """Each fold's place (px): its column is the length of the longest way to it."""
    level = [0] * count
    for a, b in edges:
        level[b] = max(level[b], level[a] + 1)
    places: dict[int, Point2] = {}
    for column in range(max(level) + 1):
        here = [i for i in range(count) if level[i] == column]
        for row, index in enumerate(here):
            y = _HEIGHT_PX * (row + 0.5) / len(here) - 18
            places[index] = (_FIRST_PX + _COLUMN_PX * column, y)
    return places


def _before(index: int, edges: tuple[tuple[int, int], ...]) -> int:
    """Return the folds that must precede a fold, as a bit mask."""
    found = 0
    for a, b in edges:
        if b == index:
            found |= 1 << a | _before(a, edges)
    return found


def _fold(view: View, sequence: FoldSequence, index: int, done: int) -> None:
    fold, moving = sequence.folds[index], sequence.folded(done, index).moving
    for layer in sequence.cloth(done).layers:
        view.polygon("layer", layer.region.ring, Style(EDGE, FRONT, 1.0))
    view.polygon("moving", moving.ring, Style(EDGE, BACK, 1.0))
    view.polygon("lands", moving.moved(Isometry.reflection(fold.line)).ring, Style(EDGE, width=1.2, dash="4 3"))
    view.line("fold-line", (fold.line.start, fold.line.end), Style(BLUE, width=3.0))
