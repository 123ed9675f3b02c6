"""Shortcuts change the path of one arm between two rows, and nothing else."""

import numpy as np

from planner.motion.path_shortcuts import places, shortcuts
from planner.robots.card import JointLayout
from planner.robots.load_robot import load_robot

LAYOUT = JointLayout.of(load_robot("pr2").card)
DETOUR = LAYOUT.home + np.sin(np.linspace(0.0, np.pi, 31))[:, None] * np.where(LAYOUT.owners == 1, 0.5, 0.1)


def test_an_arm_cuts_across_while_the_others_keep_to_their_path() -> None:
    evenly, early, late = shortcuts(DETOUR, LAYOUT, (1, 5, 20))
    one, other = LAYOUT.spans[1], LAYOUT.spans[0]
    for cut in (evenly, early, late):
        np.testing.assert_array_equal(cut[:, other], DETOUR[:, other])
        np.testing.assert_array_equal(cut[[*range(6), *range(20, 31)], one], DETOUR[[*range(6), *range(20, 31)], one])
        along = cut[5:21, one] - DETOUR[5, one]
        assert np.linalg.matrix_rank(along, tol=1e-9) == 1
    np.testing.assert_allclose(early[15:21, one], np.tile(DETOUR[20, one], (6, 1)))
    np.testing.assert_allclose(late[5:10, one], np.tile(DETOUR[5, one], (5, 1)))


def test_the_longest_shortcut_of_the_arm_that_takes_longest_is_the_first() -> None:
    found = [*places(DETOUR, LAYOUT, 3, (4, 26))]
    assert found[:2] == [(1, 4, 26), (0, 4, 26)]
    assert all(4 <= first < last <= 26 for _, first, last in found)
    mirrored = np.concatenate([DETOUR[:, LAYOUT.spans[1]], DETOUR[:, LAYOUT.spans[0]]], axis=1)
    assert [*places(mirrored, LAYOUT, 3, (4, 26))] == [(1 - arm, first, last) for arm, first, last in found]
