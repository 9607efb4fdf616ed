"""Ways over an occupancy grid, and the speeds that follow them without touching anything."""
