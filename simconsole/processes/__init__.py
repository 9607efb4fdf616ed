"""Processes around the core, and the memory they share."""
