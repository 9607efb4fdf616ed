"""Mapping and localisation from a lidar: scans and odometry in, an occupancy grid and poses out."""
