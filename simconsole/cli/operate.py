"""`simconsole operate`: an operator's act in a running drive, over its rosbridge server."""

import time
from argparse import Namespace
from typing import Any

from simconsole.cli.outcome import Outcome
from simconsole.cli.remote import own_token
from simconsole.values.errors import BridgeError

_PATIENCE_S = 5.0


def operate(options: Namespace) -> Outcome:
    """Ask the console at `options.url` for one act; 1 if it does not take it.

    Raises:
        BridgeError: no server listens there, or it does not answer.
    """
    from simconsole.bridge.client.bridge_client import BridgeClient
    from simconsole.bridge.console.operator_acts import OPERATE

    args = {"act": options.act, "note": options.note, "participant": options.participant, "trial": options.trial}
    answers: list[tuple[Any, bool]] = []
    with BridgeClient(options.url, token=own_token(), comes_back=False) as client:
        client.connect()
        client.call_service(options.namespace + OPERATE, args, lambda values, good: answers.append((values, good)))
        deadline_s = time.monotonic() + _PATIENCE_S
        while not answers and time.monotonic() < deadline_s:
            client.receive(0.05)
    if not answers:
        raise BridgeError(f"{options.url}: no answer within {_PATIENCE_S:g} s")
    values, good = answers[0]
    if not good:
        return Outcome(1, {"accepted": False, "reason": str(values)}, f"refused: {values}")
    return Outcome(0, dict(values), f"{options.act}: after tick {values['tick']}")
