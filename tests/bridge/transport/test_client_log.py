import logging
from http import HTTPStatus

import pytest

from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.handshake import Refusal
from simconsole.bridge.protocol.server_protocol import Outcome
from simconsole.bridge.transport.client_log import log_departure, log_outcome, log_refusal

LOGGER = logging.getLogger("simconsole.bridge.test")


def test_flood_of_refusals_does_not_fill_the_log(caplog: pytest.LogCaptureFixture) -> None:
    session = ClientSession(1, "peer", 1000, lambda: None)
    with caplog.at_level(logging.INFO, LOGGER.name):
        for number in range(1, 5001):
            session.refused = number
            log_outcome(LOGGER, session, Outcome("refused", "/cmd", "no"))
        log_outcome(LOGGER, session, Outcome("done", "/cmd", ""))
        log_outcome(LOGGER, session, Outcome("remark", "", "info: hello"))
    lines = [record.getMessage() for record in caplog.records]
    assert len(lines) == 10 + 5 + 1
    assert lines[0] == "peer: refused (1): /cmd no"
    assert lines[-1] == "peer: says info: hello"


def test_departure_of_the_commander_is_a_warning(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, LOGGER.name):
        log_departure(LOGGER, "driver", True)
        log_departure(LOGGER, "viewer", False)
    assert [(record.levelname, record.getMessage()) for record in caplog.records] == [
        ("WARNING", "driver was commanding and is gone"),
        ("INFO", "viewer is gone"),
    ]


def test_who_is_turned_away_is_logged_now_and_then_and_who_asks_for_the_version_never(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with caplog.at_level(logging.INFO, LOGGER.name):
        for number in range(1, 2001):
            log_refusal(LOGGER, number, Refusal(HTTPStatus.FORBIDDEN, "no"))
        log_refusal(LOGGER, 1, Refusal(HTTPStatus.OK, "1.0"))
    lines = [record.getMessage() for record in caplog.records]
    assert lines == [f"connection refused ({number}): no" for number in (*range(1, 11), 1000, 2000)]
