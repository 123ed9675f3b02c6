"""Propose folds that bring a garment to a size, each planned for the robot."""

from dataclasses import replace

from planner import load_garment, propose_folds

vest = replace(load_garment("vest"), folds=())
for proposal in propose_folds(vest, (0.25, 0.30), count=2):
    width_m, length_m = proposal.size_m
    names = [fold.name for fold in proposal.garment.folds]
    print(f"{100 * width_m:.0f} x {100 * length_m:.0f} cm, {proposal.status}, {proposal.cost_s} s: {names}")
