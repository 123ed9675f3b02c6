"""A template process that cannot load the planner."""

raise RuntimeError("the kernels are for another machine")
