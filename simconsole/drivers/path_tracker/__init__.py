"""The path tracker of the ROS side's driver: steering, planned speed, way back to the path. Pure."""
