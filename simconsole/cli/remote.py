"""`simconsole autopilot`: the ROS side's driver, as a program of its own."""

import math
import os
from argparse import Namespace

from simconsole.cli.outcome import Outcome, table
from simconsole.processes.lifetimes import DRIVE_VARIABLE, follow_parent
from simconsole.session.autopilot_program import TOKEN_VARIABLE
from simconsole.values.errors import ProfileError

END_S = 0.5
"""Longest time that the program may take to end once the console that started it asks for the end."""


def own_token() -> str | None:
    """Return the token for a server, from the environment: every user can read a program's arguments."""
    return os.environ.pop(TOKEN_VARIABLE, None)


def autopilot(options: Namespace) -> Outcome:
    """Follow a course over rosbridge until the console closes the connection, or ends where it started this program.

    Raises:
        ProfileError: a `--rename` is not of the form /TOPIC=/NAME.
        OtherDriveError: the console there is not the one that started this program.
    """
    stop = follow_parent(END_S).wants_end if options.attached else None
    from simconsole.bridge.protocol.backoff import DEAD_AFTER_S
    from simconsole.drivers.autopilot.rosbridge_autopilot import run
    from simconsole.drivers.path_tracker.tracker_settings import Gate

    results = run(
        options.url,
        options.course,
        stop=stop,
        namespaces=options.namespace or ("",),
        rename=_renamed(options.rename),
        patience_s=options.wait,
        token=own_token(),
        certificate=options.certificate,
        drive=os.environ.pop(DRIVE_VARIABLE, None),
        vehicle=options.vehicle,
        delay_s=options.delay_ms / 1000.0,
        tracker=options.tracker,
        plan_hz=options.plan_hz,
        speed_advice=options.speed_advice,
        gate=Gate(options.lateral_accel, options.lateral_jerk),
        # A console that started this program and is gone closes its pipe; one that is silent is merely held up.
        dead_after_s=math.inf if options.attached else DEAD_AFTER_S,
    )
    return Outcome(0, results, table([(name, str(value)) for name, value in results.items()]))


def _renamed(given: list[str]) -> dict[str, str]:
    pairs = [one.partition("=") for one in given]
    for one, (standard, _, name) in zip(given, pairs, strict=True):
        if not (standard.startswith("/") and name.startswith("/")):
            raise ProfileError(f"--rename: {one}: expected /TOPIC=/NAME")
    return {standard: name for standard, _, name in pairs}
