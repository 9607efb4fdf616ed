"""Drives whose inputs a scenario holds: its events, messages and road users, and a session opened for them."""
