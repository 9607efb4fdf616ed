"""What each command does. main.py reads the words; the other modules, imported only when needed, do the work."""
