"""Motion: joint paths for what primitives do, from transfer to transit, and the trajectory that they make."""
