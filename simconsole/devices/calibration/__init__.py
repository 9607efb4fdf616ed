"""From raw axes to a driver's input: pure."""
