"""What each command does. cli.py reads the words; these modules, imported only when needed, do the work."""
