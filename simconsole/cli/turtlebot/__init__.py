"""`simconsole turtlebot`: the use case of three robots, in one command."""
