"""The console as a ROS 2 node."""
