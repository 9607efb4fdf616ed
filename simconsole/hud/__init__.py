"""The driver's seat: layout and window."""
