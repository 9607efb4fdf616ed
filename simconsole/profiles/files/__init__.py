"""The only door to YAML: profiles read from files."""
