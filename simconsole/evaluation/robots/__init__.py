"""What a team of robots did, against the truth: figures, tables, a picture."""
