"""Road maps: their values, where a pose lies on them, and routes over them. Pure."""
