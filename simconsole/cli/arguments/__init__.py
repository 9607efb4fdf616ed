"""What each command takes on the command line. No heavy library is imported here."""
