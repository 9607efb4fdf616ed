"""Speed advice for a person: a worker that hears what any client of the bridge hears."""
