"""Time limits for searches of several seconds of counted work, on a busy machine."""

SEARCH_MS = 180_000
"""The time for the first suggestion, or a map of placements (ms)."""
