"""Controllers of a console's car, on the ROS side."""
