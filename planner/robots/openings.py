"""How wide fingers are open, and where: when they hold cloth, when one slides under it, and at most."""

HELD_M = 0.001
"""The fingers' opening while they hold cloth at its edge (m): its layers, pressed."""

EDGE_OPEN_M = 0.01
"""The opening with which one finger slides under the cloth at its edge and the other over it (m)."""

OPENING_M = 0.06
"""Default upper limit of the fingers' opening where they are compared with other things (m)."""

RAISED_MAX_M, LOWERED_MAX_M = 0.004, 0.03
"""How far above and below the height of its path a hand may take cloth and let go of it (m)."""
