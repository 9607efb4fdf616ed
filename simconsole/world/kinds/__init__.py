"""From a world's profile to the world, whatever its kind."""
