"""What there is, and what it means: names of profiles, keys of profiles, the newest drives."""
