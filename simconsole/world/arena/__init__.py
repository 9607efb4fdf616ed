"""Arenas of robots: walls and obstacles on a flat floor, as something to drive in, to see and to measure."""
