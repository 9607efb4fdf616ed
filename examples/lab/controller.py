"""The lab's controller: holds a speed, and brakes for the last seconds."""

import simconsole


def controller(seen: simconsole.Snapshot) -> simconsole.Command:
    """Hold 8 m/s for 8 s, then stop."""
    return simconsole.hold_speed(8.0 if seen.t_s < 8.0 else 0.0)
