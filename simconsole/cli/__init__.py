"""What each command does. main.py reads the arguments; the other modules, imported only when needed, do the work."""
