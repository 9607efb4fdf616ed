"""A test driver: runs up to a speed, drives a manoeuvre, and works the axes of the cockpit. Pure."""
