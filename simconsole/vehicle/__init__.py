"""The vehicles: platforms behind one interface."""
