"""Explaining: why there is no plan, and what would give one: questions put to planning."""
