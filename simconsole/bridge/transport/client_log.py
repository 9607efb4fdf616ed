"""The log of a server's clients: what was refused, and who has gone."""

import logging
from http import HTTPStatus
from typing import Final

from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.handshake import Refusal
from simconsole.bridge.protocol.server_protocol import Outcome

_LOGGED_REFUSALS: Final = 10
_LOGGED_EVERY: Final = 1000


def log_refusal(logger: logging.Logger, count: int, refusal: Refusal) -> None:
    """Log why a connection was turned away, the first and later ones now and then; `count` is how many were so far."""
    if refusal.status >= HTTPStatus.BAD_REQUEST and (count <= _LOGGED_REFUSALS or count % _LOGGED_EVERY == 0):
        logger.warning("connection refused (%d): %s", count, refusal.reason)


def log_outcome(logger: logging.Logger, session: ClientSession, outcome: Outcome) -> None:
    """Log what was refused, the first of a client each and later ones now and then: a flood must not fill the disk."""
    if outcome.kind == "refused":
        if session.refused <= _LOGGED_REFUSALS or session.refused % _LOGGED_EVERY == 0:
            logger.warning("%s: refused (%d): %s %s", session.peer, session.refused, outcome.topic, outcome.text)
    elif outcome.kind == "remark":
        logger.info("%s: says %s", session.peer, outcome.text)


def log_departure(logger: logging.Logger, peer: str, was_commanding: bool) -> None:
    """Log that a client is gone; as a warning if that has taken the console's commander away."""
    if was_commanding:
        logger.warning("%s was commanding and is gone", peer)
    else:
        logger.info("%s is gone", peer)
