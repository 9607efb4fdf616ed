"""What each key of a profile means, for people and for editors; read from the sources only when it is asked for."""
