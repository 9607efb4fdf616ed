"""`simconsole autopilot`: the ROS side's driver, as a program of its own."""

import os
from argparse import Namespace

from simconsole.commands.outcome import Outcome, table
from simconsole.inline import TOKEN_VARIABLE


def autopilot(words: Namespace) -> Outcome:
    """Follow a course over rosbridge until the console closes the connection."""
    from simconsole.autonomy.autopilot import run

    token = os.environ.pop(TOKEN_VARIABLE, None)
    results = run(words.url, words.course, patience_s=words.wait, token=token, certificate=words.certificate)
    return Outcome(0, results, table([(name, str(value)) for name, value in results.items()]))
