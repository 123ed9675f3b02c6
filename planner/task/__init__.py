"""The values that planning takes and returns: tasks, plans, trajectories, scenes and reasons."""
