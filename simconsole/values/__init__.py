"""The bottom: the values of a tick, their layout, units, errors, arithmetic. Imports nothing of ours."""
