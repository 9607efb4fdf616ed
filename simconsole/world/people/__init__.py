"""People on foot: the crossings of a road map, the ways that lead over them, and those who walk there. Pure."""
