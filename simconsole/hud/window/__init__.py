"""The window that the draw lists are painted in."""
