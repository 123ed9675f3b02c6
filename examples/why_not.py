"""Ask why a garment cannot be folded, and for the smallest changes after which it can."""

from itertools import islice

from planner import Task, load_garment, make_plan, suggestions

task = Task.of(load_garment("scarf-halved"))
plan = make_plan(task)
for reason in plan.reasons:
    print(f"fold {reason.fold}: {reason.says.text}")
for suggestion in islice(suggestions(task, plan=plan), 2):
    print("suggestion:", suggestion.message)
