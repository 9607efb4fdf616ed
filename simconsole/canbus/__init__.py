"""The console on a CAN bus: codec, protection, schedule and node without a bus; port, station and tools with one."""
