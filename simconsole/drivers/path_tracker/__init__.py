"""The ROS side's driver: a program that only speaks rosbridge."""
