"""The cockpit: sources, roles, calibration and validity."""
