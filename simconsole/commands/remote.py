"""`simconsole autopilot` and `simconsole bridge serve`: the programs of the ROS side, and a server to try them on."""

from argparse import Namespace

from simconsole.commands.outcome import Outcome, table


def autopilot(words: Namespace) -> Outcome:
    """Follow a course over rosbridge until the console closes the connection."""
    from simconsole.autonomy.autopilot import run

    results = run(words.url, words.course)
    return Outcome(0, results, table([(name, str(value)) for name, value in results.items()]))
