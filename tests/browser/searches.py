"""How long searches may take that do several seconds of counted work, on a machine that does other things too."""

SEARCH_MS = 90_000
"""For the first suggestion, or a map of placements."""
