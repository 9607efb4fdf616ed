"""Programs that write worlds."""
