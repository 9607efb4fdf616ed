"""Programs on the ROS side that speak only rosbridge: SLAM, and navigation."""
