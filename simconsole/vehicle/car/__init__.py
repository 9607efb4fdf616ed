"""The car: four sprung wheels, six degrees of freedom, tyre deflection, rack, clutch, gears, engine, brakes, aids.

One step of 1 ms is `car_step.substep`; it knows the order. `state.py` and `parameters.py` hold what it works on;
`car_platform.py` turns a profile into a platform.
"""
