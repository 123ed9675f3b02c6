"""Motion: joint paths for primitives, transfers with cloth held and transits with empty hands, and their trajectory."""
