"""Sample a plan: where base and grippers are, and every joint's angle, at any time."""

from planner import Timeline, load_garment, make_plan

timeline = Timeline.of(make_plan(load_garment("vest")))
for sample in timeline.samples(rate_hz=1.0):
    opening_m = ", ".join(f"{arm} {opening:.3f} m" for arm, opening in sample.grippers_m.items())
    print(f"{sample.t_s:5.1f} s  step {sample.primitive}  base x {sample.base.x_m:.2f} m  {opening_m}")
