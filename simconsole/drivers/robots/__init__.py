"""Programs of robots, on the ROS side: they know of the console only what it publishes."""
