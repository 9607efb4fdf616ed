"""Profiles read from files: the only package that reads YAML."""
