import math
import random

import cantools
import cantools.database
import pytest

from simconsole.canbus.codec import COMMAND, CONSOLE, ECU, Codec
from simconsole.canbus.messages import REQUESTS
from simconsole.canbus.protection import Check
from simconsole.profiles.files.loader import read_text
from simconsole.values.errors import CanError
from simconsole.values.signals import Event, GateLimit, Mode, Reason, Validity

TEXT = read_text("can", "simconsole.dbc")
GOOD = {
    "REQUEST": 1.0,
    "ROAD_WHEEL": -0.2,
    "ACCEL": -1.5,
    "DIRECTION": -1.0,
    "TURN_INDICATORS": -1.0,
    "HAZARD_LIGHTS": 1.0,
}


@pytest.fixture(scope="module")
def database() -> cantools.database.Database:
    found = cantools.database.load_string(TEXT, "dbc")
    assert isinstance(found, cantools.database.Database)
    return found


def test_who_sends_what(codec: Codec) -> None:
    assert [info.name for info in codec.sent_by(ECU)] == [COMMAND]
    assert codec.ids(CONSOLE) == {0x100, 0x101, 0x102, 0x103, 0x110, 0x111, 0x112, 0x120}
    assert not codec.ids(CONSOLE) & codec.ids(ECU)


def test_rates(codec: Codec) -> None:
    rates = {name: 1000 / info.period_ms for name, info in codec.messages.items()}
    assert rates["SC_STEERING"] == rates["SC_PEDALS"] == 100
    assert rates["SC_MOTION"] == rates["SC_WHEELS"] == rates["SC_POWERTRAIN"] == 50
    assert rates["SC_STATUS"] == 10


def test_every_message_and_every_unit_is_documented(codec: Codec) -> None:
    units = {signal.unit for info in codec.messages.values() for signal in info.signals.values()}
    assert units == {"", "rad", "rad/s", "m/s", "m/s^2", "rpm", "ms", "Nm"}
    assert all(info.comment for info in codec.messages.values())


def test_random_values_are_packed_as_cantools_packs_them(codec: Codec, database: cantools.database.Database) -> None:
    seed = 61
    values = random.Random(seed)
    for info in codec.messages.values():
        for counter in range(40):
            wanted = {name: values.uniform(about.low, about.high) for name, about in info.signals.items()}
            frame = codec.encode(info.name, wanted, counter)
            read = database.decode_message(frame.can_id, frame.data, decode_choices=False)
            assert isinstance(read, dict)
            assert read["COUNTER"] == counter % 16
            decoded = codec.decode(info.name, frame.data)
            assert decoded is not None
            for name, about in info.signals.items():
                assert abs(decoded[name] - wanted[name]) <= about.half_step * (1 + 1e-6), f"seed {seed}: {name}"
                assert decoded[name] == pytest.approx(float(read[name]), abs=1e-9)  # type: ignore[arg-type]
            theirs = database.encode_message(frame.can_id, {**read})
            assert theirs == frame.data


def test_bounds_of_every_signal_fit_into_its_bits(codec: Codec) -> None:
    for info in codec.messages.values():
        for edge in ("low", "high"):
            wanted = {name: getattr(about, edge) for name, about in info.signals.items()}
            decoded = codec.decode(info.name, codec.encode(info.name, wanted, 0).data)
            assert decoded == pytest.approx(wanted)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1.21, -1.21, 1e30])
def test_value_out_of_range_is_refused_by_name(codec: Codec, value: float) -> None:
    with pytest.raises(CanError, match=r"ECU_COMMAND\.ROAD_WHEEL: value .*: -1\.2 to 1\.2"):
        codec.encode(COMMAND, {**GOOD, "ROAD_WHEEL": value}, 0)


def test_missing_signal_is_refused(codec: Codec) -> None:
    with pytest.raises(CanError, match="ACCEL"):
        codec.encode(COMMAND, {key: value for key, value in GOOD.items() if key != "ACCEL"}, 0)


def test_clip_sends_the_bound_but_never_what_is_not_finite(codec: Codec) -> None:
    frame = codec.encode(COMMAND, {**GOOD, "ACCEL": 99.0, "ROAD_WHEEL": -99.0}, 0, clip=True)
    decoded = codec.decode(COMMAND, frame.data)
    assert decoded is not None
    assert (decoded["ACCEL"], decoded["ROAD_WHEEL"]) == (pytest.approx(12.0), pytest.approx(-1.2))
    for value in (math.nan, math.inf, -math.inf):
        with pytest.raises(CanError):
            codec.encode(COMMAND, {**GOOD, "ACCEL": value}, 0, clip=True)


def test_raw_values_beyond_a_range_decode_to_nothing(codec: Codec) -> None:
    word = int.from_bytes(codec.encode(COMMAND, GOOD, 0).data, "little")
    beyond = word & ~(0xFFFF << 32) | 0x7FFF << 32  # ACCEL 32.767 m/s^2
    assert codec.decode(COMMAND, beyond.to_bytes(8, "little")) is None
    reverse = word | 2 << 48 & ~(1 << 48)  # DIRECTION -2
    reverse &= ~(1 << 48)
    assert codec.decode(COMMAND, reverse.to_bytes(8, "little")) is None


def choices(database: cantools.database.Database, message: str, signal: str) -> dict[int, str]:
    table = database.get_message_by_name(message).get_signal_by_name(signal).choices
    assert table is not None
    return {int(number): str(word) for number, word in table.items()}


def test_words_of_the_dbc_are_those_of_the_console(database: cantools.database.Database) -> None:
    assert choices(database, "SC_STATUS", "MODE") == {int(member): member.name for member in Mode}
    assert choices(database, "SC_STATUS", "REASON") == {int(member): member.name for member in Reason}
    assert choices(database, "SC_STATUS", "COMMAND_STATE") == {int(member): member.name for member in Check}
    assert choices(database, "SC_STEERING", "WHEEL_VALIDITY") == {int(member): member.name for member in Validity}
    asked = {number: word for number, word in choices(database, COMMAND, "REQUEST").items() if number}
    named = {number: event.name.removeprefix("REQUEST_") for number, event in REQUESTS.items() if event.name}
    assert asked == named
    assert choices(database, COMMAND, "DIRECTION") == {1: "DRIVE", 0: "NEUTRAL", -1: "REVERSE"}
    for message in ("SC_ACTUATION", COMMAND):
        assert choices(database, message, "TURN_INDICATORS") == {1: "LEFT", 0: "OFF", -1: "RIGHT"}
    assert max(GateLimit) < 256
    assert set(REQUESTS.values()) <= set(Event)


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ("BO_ 512 ECU_COMMAND: 8 ECU", "BO_ 512 ECU_COMMAND: 7 ECU", "ECU_COMMAND"),
        ("BU_: CONSOLE ECU", "BU_ CONSOLE", "DBC"),
        ('BA_ "GenMsgCycleTime" BO_ 512 20;', "", "GenMsgCycleTime"),
        ('SG_ ACCEL : 32|16@1- (0.001,0) [-12|12] "m/s^2"', 'SG_ ACCEL : 39|16@0- (0.001,0) [-12|12] "m/s^2"', "ACCEL"),
        ('SG_ COUNTER : 8|4@1+ (1,0) [0|15] "" CONSOLE', 'SG_ COUNT : 8|4@1+ (1,0) [0|15] "" CONSOLE', "COUNTER"),
        ("BO_ 512 ", "BO_ 2147484160 ", "DBC"),
    ],
)
def test_dbc_that_cannot_serve_is_refused_in_one_line(old: str, new: str, word: str) -> None:
    assert old in TEXT
    with pytest.raises(CanError, match=word) as caught:
        Codec(TEXT.replace(old, new))
    assert "\n" not in str(caught.value)
