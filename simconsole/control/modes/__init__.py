"""Who drives: the table of modes, what asks for a change, what decides."""
