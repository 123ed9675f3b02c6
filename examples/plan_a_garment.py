"""Plan a shipped garment for the PR2 and print its steps."""

from planner import load_garment, make_plan

plan = make_plan(load_garment("vest"))
print(f"{plan.status}: {plan.cost_s:.1f} s, proven: {plan.is_proven}")
for step in plan.steps:
    print(f"{step.start_s:6.1f} s  {step.kind}  {step.duration_s:.1f} s")
