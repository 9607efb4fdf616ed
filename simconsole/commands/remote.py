"""`simconsole autopilot`: the ROS side's driver, as a program of its own."""

from argparse import Namespace

from simconsole.commands.outcome import Outcome, table


def autopilot(words: Namespace) -> Outcome:
    """Follow a course over rosbridge until the console closes the connection."""
    from simconsole.autonomy.autopilot import run

    results = run(words.url, words.course, patience_s=words.wait)
    return Outcome(0, results, table([(name, str(value)) for name, value in results.items()]))
