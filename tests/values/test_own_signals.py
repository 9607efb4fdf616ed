"""A lab's own signals: what may be declared, what may be set, what the log is given."""

import math
import struct

import pytest

from simconsole.values.errors import RecordingError
from simconsole.values.own_signals import MOST_SIGNALS, OWN, OwnSignals


@pytest.mark.parametrize(
    "names", [(), ("a", "a"), ("Gain",), ("a.b",), ("1st",), ("x" * 65,), tuple(f"s{n}" for n in range(257))]
)
def test_names_that_are_no_columns_are_refused(names: tuple[str, ...]) -> None:
    with pytest.raises(RecordingError, match="own signals"):
        OwnSignals(*names)


def test_as_many_as_there_may_be() -> None:
    assert len(OwnSignals(*(f"s{n}" for n in range(MOST_SIGNALS))).names) == MOST_SIGNALS


def test_the_log_is_given_all_values_when_one_was_set_and_nothing_otherwise() -> None:
    signals = OwnSignals("gain", "error_m")
    assert signals.take_messages(0) == []
    signals.set(error_m=-0.25)
    ((stream, content),) = signals.take_messages(0)
    gain, error = struct.unpack("<2d", content)
    assert (stream, math.isnan(gain), error) == (OWN, True, -0.25)
    assert signals.take_messages(0) == []
    signals.set(gain=2)
    assert struct.unpack("<2d", signals.take_messages(0)[0][1]) == (2.0, -0.25)


def test_a_new_drive_begins_with_nothing_said() -> None:
    signals = OwnSignals("gain", "error_m")
    signals.set(gain=1.0, error_m=1.0)
    signals.forget()
    assert signals.take_messages(0) == []
    signals.set(gain=3.0)
    assert math.isnan(struct.unpack("<2d", signals.take_messages(0)[0][1])[1])


def test_a_signal_that_was_not_declared_is_named() -> None:
    with pytest.raises(RecordingError, match="'gian': one of gain, error_m"):
        OwnSignals("gain", "error_m").set(gian=1.0)


def test_what_is_no_number_is_refused() -> None:
    with pytest.raises(ValueError, match="could not convert"):
        OwnSignals("gain").set(gain="much")  # type: ignore[arg-type]
