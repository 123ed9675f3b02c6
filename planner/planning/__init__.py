"""Planning: from a task to a plan."""
