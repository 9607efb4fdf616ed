"""`simconsole sweep`."""
