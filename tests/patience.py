"""How long tests wait for what must come: far longer than it takes, for the machine may be busy."""

PATIENCE_S = 300.0
