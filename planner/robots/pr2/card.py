"""The PR2's card: its JSON card, with what the closed form of its arms and the view from its eyes need."""

from dataclasses import replace

import pinocchio as pin

from planner.robots.card import RobotCard
from planner.robots.described_card import card_on
from planner.robots.described_robot import lift_limits
from planner.robots.known_robots import read_card, shipped_path
from planner.robots.pr2.description import package_directory, urdf_path


def pr2_card(model: pin.Model) -> RobotCard:
    """Return the card of a PR2, with numbers from its kinematic tree."""
    described = read_card(shipped_path("pr2"))
    card = card_on(described, model, lift_limits(model, described), urdf_path(), package_directory())
    left, right = card.arms
    return replace(card, arms=(left, replace(right, is_mirrored=True)), eye_frame="head_plate_frame")
