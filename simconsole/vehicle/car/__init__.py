"""The car: a dynamic single-track model with tyre deflection, clutch, gears, engine and friction brakes.

One step of 1 ms is `step.substep`; it knows the order. `state.py` and `parameters.py` hold what it works on;
`assembly.py` turns a profile into a platform.
"""
