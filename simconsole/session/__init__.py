"""A session: resolved, opened, driven, closed."""
