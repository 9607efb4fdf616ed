"""Opens the components that a session's profile names, for headless and for paced drives."""
