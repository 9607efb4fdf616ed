"""What a robot tells over rosbridge, and what it hears: the topics of a TurtleBot3."""
