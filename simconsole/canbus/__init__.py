"""The console on a CAN bus: codec, protection, schedule and node without a bus; port, worker and tools with one."""
