"""rerun: the scene shown and exported."""
