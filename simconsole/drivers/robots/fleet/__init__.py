"""Several robots as a team: they explore together, share tasks out, and give each other way."""
