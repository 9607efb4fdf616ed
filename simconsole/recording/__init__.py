"""The append log, the bundle, replay and comparison."""
