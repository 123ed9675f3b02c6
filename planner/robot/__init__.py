"""The robot: its card, which poses its tools can take, and the joints that take them there."""
