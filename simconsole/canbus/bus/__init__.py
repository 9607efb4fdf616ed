"""CAN buses, and the worker that runs the console's node on one."""
