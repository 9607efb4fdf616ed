"""SUMO's files: networks and polygons read, courses written, other formats converted."""
