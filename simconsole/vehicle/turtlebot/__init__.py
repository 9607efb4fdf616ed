"""TurtleBot3 robots: differential drive, with the wheel encoders and the odometry that they have on board."""
