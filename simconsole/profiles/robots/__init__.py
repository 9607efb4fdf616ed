"""Parts of robots' profiles."""
