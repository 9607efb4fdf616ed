"""The CAN bus: its room is ready, a later release fills it."""
