"""The lowest layer: the values of a tick, their layout, units, errors, arithmetic. Imports no other package of ours."""
