"""The road: course, crossings, lights."""
