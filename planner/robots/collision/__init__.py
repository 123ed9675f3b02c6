"""Collision checks between the arms, the body and the table."""
