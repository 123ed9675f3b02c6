"""See how the place of a garment changes what its plan costs."""

from dataclasses import replace

from planner import Task, load_garment, make_plan

garment = load_garment("scarf")
lies = garment.placement
for nearer_m in (0.0, 0.10):
    task = Task.of(garment, placement=replace(lies, x_m=lies.x_m - nearer_m))
    plan = make_plan(task)
    print(f"{nearer_m:.2f} m nearer: {plan.status}, {plan.cost_s or float('nan'):.1f} s, {len(plan.steps)} steps")
