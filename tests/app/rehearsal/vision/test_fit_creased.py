"""Stacks that lie about where they ought to, with a last fold beside its line, and creases inside of theirs."""

from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.vision.fit_creased import Creased
from app.rehearsal.vision.fit_fold import FoldedOutline
from app.rehearsal.vision.fit_stack import fit_near
from app.rehearsal.vision.outline_edges import CreaseEdges, OutlineEdges
from app.rehearsal.vision.seen_stack import SeenStack
from app.rehearsal.vision.stack_figure import Figure
from app.rehearsal.vision.stack_fit import LOOKS_ALIKE, Expected, StackFit
from planner import load_garment
from planner.folds.fold_sequence import FoldSequence, replayed
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.message import Message
from tests.app.rehearsal.vision.outlines_seen import most_off, seen

LIES = Pose2(0.05, -0.1, -1.2)
NEAR = Pose2(0.062, -0.092, -1.17)


def fitted(contour: FloatArray, sequence: FoldSequence, folds: tuple[int, ...]) -> SeenStack:
    whole = fit_near(contour, sequence.cloth(sum(1 << fold for fold in folds)), NEAR)
    return Creased.of(contour, sequence, folds, Expected(NEAR)).fitted(whole)


def test_creases_and_edges_of_a_towel_folded_in_half_are_told_apart() -> None:
    sequence = replayed(load_garment("hand-towel"))  # .686 x .419 m, its near half folded up at y = .2095 m
    edges = CreaseEdges.of(sequence.cloth(1), sequence.garment.pattern)
    points = np.array([(0.3, 0.2095), (0.3, 0.2095 - 0.004), (0.3, 0.419), (0.0, 0.3)])
    assert edges.are_creases(points).tolist() == [True, False, False, False]
    assert edges.are_creases(points, 0.003).tolist() == [True, True, False, False]
    flat = CreaseEdges.of(sequence.cloth(0), sequence.garment.pattern)
    assert not flat.are_creases(points).any()


def test_a_flap_that_landed_short_is_found_and_the_stack_under_it_stays_where_it_is() -> None:
    sequence = replayed(load_garment("t-shirt"))
    folded = FoldedOutline(sequence, 0b11, 2)
    stack = fitted(seen(folded.region(0.007, 0.0), LIES), sequence, (0, 1, 2))
    assert most_off(sequence.cloth(0b111).silhouette, stack.placement, LIES) < 0.003
    assert stack.row[3] == pytest.approx(0.007, abs=0.002)
    corners = folded.landed.hull
    on_line = np.abs(folded.line.left_distances(corners)) < 1e-6
    gone = folded.astray(0.007, 0.0).apply(corners) - corners
    assert on_line.sum() == 2
    assert stack.beside(corners[~on_line]) == pytest.approx(gone[~on_line], abs=0.005)
    assert stack.beside(corners[on_line]) == pytest.approx(gone[on_line] / 2.0, abs=0.0025)  # on the crease
    assert not stack.beside(np.array([[0.4, 0.02]])).any()  # on the right side, which nothing has moved


def test_creases_that_turn_over_in_a_loop_do_not_pull_the_stack_along() -> None:
    # The towel's crease is at y = .2095 m; seen 6 mm inside of it, the far edge and the sides where they were put.
    sequence = replayed(load_garment("hand-towel"))
    points = seen(sequence.cloth(1).silhouette, LIES)
    inner = LIES.to_inner(points)
    at_crease = inner[:, 1] < 0.2095 + 0.006
    inner[at_crease, 1] = np.maximum(inner[at_crease, 1], 0.2095) + 0.006
    stack = fitted(LIES.to_outer(inner), sequence, (0,))
    assert most_off(sequence.cloth(1).silhouette, stack.placement, LIES) < 0.0025
    assert stack.row[5] - stack.row[3] == pytest.approx(0.006, abs=0.0025)


def test_the_edge_of_a_flap_that_lies_upon_an_equal_one_is_told_to_be_unsure() -> None:
    sequence, corner = replayed(load_garment("hand-towel")), np.array([[0.0, 0.419]])
    halved = fitted(seen(sequence.cloth(1).silhouette, LIES), sequence, (0,))
    flat = fitted(seen(sequence.cloth(0).silhouette, LIES), sequence, ())
    assert halved.errors(corner)[0] > 2.0 * flat.errors(corner)[0]


def test_a_flap_that_landed_turned_does_not_turn_a_stack_that_was_seen_before() -> None:
    # The flap of a halved towel sticks out at both ends of one side, and its edge is the only one seen there.
    sequence = replayed(load_garment("hand-towel"))
    folded = FoldedOutline(sequence, 0, 0)
    points, silhouette = seen(folded.region(-0.004, 0.012), LIES), sequence.cloth(1).silhouette
    whole = fit_near(points, sequence.cloth(1), NEAR)
    before = Expected(LIES.moved(0.001, -0.001), 0.003, 0.003)
    known, guessed = (Creased.of(points, sequence, (0,), near).fitted(whole) for near in (before, Expected(NEAR)))
    assert most_off(silhouette, known.placement, LIES) < 0.004
    assert known.row[4] == pytest.approx(0.012, abs=0.004)
    assert most_off(silhouette, guessed.placement, LIES) > most_off(silhouette, known.placement, LIES) + 0.002


def test_a_placement_that_fits_as_well_until_creases_are_asked_leaves_no_doubt() -> None:
    sequence = replayed(load_garment("hand-towel"))
    points = seen(sequence.cloth(1).silhouette, LIES)
    whole = fit_near(points, sequence.cloth(1), NEAR)
    doubt = replace(whole, others=(LIES.moved(0.015, 0.0),), unknown=Message(LOOKS_ALIKE, "two fit"))
    creased = Creased.of(points, sequence, (0,), Expected(NEAR))
    stack = creased.fitted(doubt)
    fit = creased.fit_of(stack)
    assert fit.is_known and fit.error_m < 0.015
    assert most_off(sequence.cloth(1).silhouette, stack.placement, LIES) < 0.003


def test_of_two_placements_that_fit_equally_well_the_error_told_covers_both() -> None:
    # The ends of a strip are hidden, so it may as well lie 3 cm further along.
    sequence = replayed(load_garment("scarf"))
    silhouette, along = sequence.cloth(0).silhouette, np.array([[0.0, 0.0], [1.0, 0.0]])
    points = seen(silhouette, LIES)
    inner = LIES.to_inner(points)
    (left, _), (right, _) = inner.min(axis=0), inner.max(axis=0)
    points = points[(inner[:, 0] > left + 0.1) & (inner[:, 0] < right - 0.1)]
    step = np.diff(LIES.to_outer(along), axis=0)[0] * 0.03
    whole = replace(fit_near(points, sequence.cloth(0), LIES), placement=LIES, others=(LIES.moved(*step),))
    creased = Creased.of(points, sequence, (), Expected(LIES))
    assert creased.fit_of(creased.fitted(whole)).error_m > 0.02


def test_what_was_seen_is_expected_and_gets_less_sure_as_things_move() -> None:
    sequence = replayed(load_garment("jeans"))
    stack = fitted(seen(sequence.cloth(0).silhouette, LIES), sequence, ())
    expected = stack.expected
    assert expected.placement == stack.placement
    assert 0.0 < expected.within_m < 0.003 and 0.0 < expected.within_rad < 0.01
    loosened = expected.loosened(0.01, 0.02)
    assert loosened.within_m == pytest.approx(np.hypot(expected.within_m, 0.01))
    assert loosened.within_rad == pytest.approx(np.hypot(expected.within_rad, 0.02))


def test_errors_told_cover_outlines_of_much_noise() -> None:
    sequence = replayed(load_garment("jeans"))
    corners = sequence.cloth(0).silhouette.hull
    covered = 0
    for seed in range(12):
        stack = fitted(seen(sequence.cloth(0).silhouette, LIES, seed, 0.004), sequence, ())
        off = np.hypot(*(stack.places(corners) - LIES.to_outer(corners)).T)
        covered += bool((off <= stack.errors(corners)).all())
    assert covered >= 11


def told_of(seen_points: FloatArray, stack: Region) -> StackFit:
    """Return what is known of a stack that is known to lie at `LIES`."""
    figure = Figure.about(stack)
    return figure.fit_of(figure.fit_at(LIES).row, seen_points, [], is_ambiguous=False)


def test_the_overlap_of_an_outline_that_ends_short_is_that_of_the_areas() -> None:
    # A rectangle of .4 x .2 m of which .05 m are missing at one end, and one of which as much sticks out.
    whole, short = (Region.polygon([(0.0, 0.0), (x, 0.0), (x, 0.2), (0.0, 0.2)]) for x in (0.4, 0.35))
    assert told_of(seen(whole, LIES), whole).overlap > 0.98
    assert told_of(seen(short, LIES), whole).overlap == pytest.approx(0.35 / 0.4, abs=0.03)
    assert told_of(seen(whole, LIES), short).overlap == pytest.approx(0.35 / 0.4, abs=0.03)


def test_a_flap_that_sticks_out_costs_more_than_its_area_of_the_overlap_and_a_corner_cut_off_most_of_it() -> None:
    whole = Region.polygon([(0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.0, 0.2)])
    flap = Region.polygon([(0.2, 0.2), (0.3, 0.2), (0.3, 0.3), (0.2, 0.3)])  # 100 cm2 beside 800 cm2
    assert told_of(seen(Region.union([whole, flap]), LIES), whole).overlap <= 0.08 / 0.09
    corner = Region.polygon([(0.4, 0.0), (0.4, 0.2), (0.2, 0.2)])  # a corner of 200 cm2
    overlap = told_of(seen(whole.difference(corner), LIES), whole).overlap  # .7 of the corner: 1 - .7 / 4 is .825
    assert overlap <= 0.825


def test_creases_inside_of_their_lines_take_nothing_off_the_overlap() -> None:
    # Two creases of .4 m, each seen 12 mm inside: of the .4 x .14 m stack they take .0096 m2, a sixth.
    sequence = replayed(load_garment("letter-towel"))
    folds = (0, 1)
    stack = sequence.cloth(0b11)
    points = LIES.to_inner(seen(stack.silhouette, LIES))
    edges = CreaseEdges.of(stack, sequence.garment.pattern)
    distances, outwards = OutlineEdges.of(stack.silhouette).distances(points)
    is_crease = edges.are_creases(points - distances[:, None] * outwards)
    points[is_crease] -= 0.012 * outwards[is_crease]
    contour = LIES.to_outer(points)
    fit = Creased.of(contour, sequence, folds, Expected(NEAR)).fit_of(fitted(contour, sequence, folds))
    assert fit_near(contour, stack, NEAR).overlap < fit.overlap
    assert fit.overlap > 0.95
