"""The path tracker as a ROS-side program."""
