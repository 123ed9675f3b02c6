"""Describe a garment of your own, see which fold waits for which, plan it and keep the plan."""

import json
from pathlib import Path
from tempfile import gettempdir

from planner import Garment, Plan, fold_dag, make_plan

napkin = Garment.from_dict(
    {
        "name": "napkin",
        "outline": [[0.0, 0.0], [0.4, 0.0], [0.4, 0.4], [0.0, 0.4]],  # metres, counter-clockwise
        "folds": [  # what lies to the left of the line, from start to end, is folded over it
            {"name": "in half", "kind": "blue", "start": [0.4, 0.2], "end": [0.0, 0.2]},
            {"name": "to a quarter", "kind": "blue", "start": [0.2, 0.2], "end": [0.2, 0.4]},
        ],
    }
)
print("edges of the Fold-DAG:", fold_dag(napkin).to_dict()["edges"])

plan = make_plan(napkin)
kept = Path(gettempdir()) / "napkin.plan.json"
kept.write_text(json.dumps(plan.to_dict()))
again = Plan.from_dict(json.loads(kept.read_text()))
print(f"{again.status}: {again.cost_s:.1f} s, read back from {kept.name}")
