"""The car: four wheels on springs under a body of six degrees of freedom, with tyre deflection, rack, clutch, gears,
engine, friction brakes and driver aids.

One step of 1 ms is `step.substep`; it knows the order. `state.py` and `parameters.py` hold what it works on;
`assembly.py` turns a profile into a platform.
"""
