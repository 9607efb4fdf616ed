"""Everything that drives. `cockpit` and `autopilot` touch devices and sockets; all else is pure."""
