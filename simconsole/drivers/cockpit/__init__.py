"""A simulated person in the seat."""
