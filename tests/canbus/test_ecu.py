import pytest

from simconsole.canbus.codec import COMMAND, Codec, Frame
from simconsole.canbus.ecu import Ecu, Listener, Wish
from simconsole.canbus.protection import Check
from simconsole.values.errors import CanError
from simconsole.values.signals import Mode


def commands(ecu: Ecu, codec: Codec, count: int) -> list[dict[str, float]]:
    found = []
    for _ in range(count):
        values = codec.decode(COMMAND, ecu.command().data)
        assert values is not None
        found.append(values)
    return found


def tell(ecu: Ecu, codec: Codec, name: str, **values: float) -> None:
    for counter in (1, 2):
        ecu.receive(codec.encode(name, dict.fromkeys(codec.messages[name].signals, 0.0) | values, counter), counter)


def test_asks_until_autonomy_is_granted(codec: Codec) -> None:
    ecu = Ecu(codec, Wish(engage=True))
    requests = [values["REQUEST"] for values in commands(ecu, codec, 40)]
    assert requests == [0] * 10 + [1] * 10 + [0] * 10 + [1] * 10
    tell(ecu, codec, "SC_STATUS", MODE=float(Mode.AUTONOMOUS))
    assert ecu.mode == Mode.AUTONOMOUS
    assert {values["REQUEST"] for values in commands(ecu, codec, 40)} == {0}


def test_holds_a_speed_from_what_the_bus_says(codec: Codec) -> None:
    ecu = Ecu(codec, Wish(speed_mps=10.0))
    assert commands(ecu, codec, 1)[0]["ACCEL"] == 0.0
    for speed_mps, accel_mps2 in ((0.0, 2.0), (9.0, 0.8), (10.0, 0.0), (20.0, -2.0)):
        ecu = Ecu(codec, Wish(speed_mps=10.0))
        tell(ecu, codec, "SC_MOTION", SPEED=speed_mps)
        assert commands(ecu, codec, 1)[0]["ACCEL"] == pytest.approx(accel_mps2, abs=1e-3)


def test_holds_a_speed_in_reverse(codec: Codec) -> None:
    ecu = Ecu(codec, Wish(speed_mps=2.0, direction=-1.0))
    tell(ecu, codec, "SC_MOTION", SPEED=-1.0)
    assert commands(ecu, codec, 1)[0]["ACCEL"] == pytest.approx(0.8)


def test_one_request_is_made_once(codec: Codec) -> None:
    ecu = Ecu(codec, Wish(request=5))
    requests = [values["REQUEST"] for values in commands(ecu, codec, 40)]
    assert requests == [0] * 10 + [5] * 30


def test_wish_beyond_the_message_is_refused(codec: Codec) -> None:
    with pytest.raises(CanError, match=r"ROAD_WHEEL: value 2\.0"):
        Ecu(codec, Wish(road_wheel_rad=2.0)).command()


def test_listener_tells_each_frame_and_counts_lost_ones(codec: Codec) -> None:
    listener = Listener(codec)
    ecu = Ecu(codec, Wish())
    frames = [ecu.command() for _ in range(6)]
    heard = [listener.take(frame, 0) for frame in (*frames[:2], frames[3], frames[3], frames[4])]
    assert [found.state for found in heard if found] == [
        *(Check.NO_NEW_DATA, Check.OK, Check.OK, Check.REPEATED, Check.OK)
    ]
    assert listener.lost() == 1
    assert listener.take(Frame(0x7FF, bytes(8)), 0) is None
