"""The robot: its card, the poses its tools can take, and the joints that take them there."""
