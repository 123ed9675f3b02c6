"""The PR2: its card, and its arms in closed form."""
