"""Explain why there is no plan, and find what would give one, by asking planning again with causes removed."""
