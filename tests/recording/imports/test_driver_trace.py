from collections.abc import Callable
from pathlib import Path

import pytest

from simconsole.devices.sources.trace_files import TraceSource
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.recording.imports.bag import Bag
from simconsole.recording.imports.driver_trace import joy_mapping, trace_rows, write_trace
from simconsole.values.errors import ProfileError, RecordingError
from simconsole.values.signals import NEVER_TICKS, NO_SAMPLE, DeviceSample
from tests.recording.imports.bags import EPOCH_NS, Written, joy, said, write_bag

HZ = 250
OWN = (0.5, 1.0, -1.0, 0.25, 0.0, -1.0, 1.0)


@pytest.fixture
def cockpit() -> CockpitProfile:
    return load("devices", "t500rs_th8rs", CockpitProfile)


@pytest.fixture
def rows(tmp_path: Path, cockpit: CockpitProfile) -> Callable[..., list[DeviceSample]]:
    def made(*messages: Written, axes: str | None = None, buttons: str | None = None) -> list[DeviceSample]:
        bag = Bag(write_bag(tmp_path / "bag", messages))
        found = list(trace_rows(bag, messages[0].topic, joy_mapping(axes, buttons, cockpit), HZ))
        assert [tick for tick, _ in found] == list(range(1, len(found) + 1))
        return [sample for _, sample in found]

    return made


def test_the_console_s_own_topic_is_what_it_was(rows: Callable[..., list[DeviceSample]]) -> None:
    buttons = [0] * 23
    buttons[2] = buttons[13 + 7] = 1
    (sample,) = rows(joy(4_000_000, OWN, buttons))
    assert sample == DeviceSample(
        wheel_axis=0.5, throttle_axis=1.0, brake_axis=-1.0, clutch_axis=0.25, handbrake_axis=0.0, wheel_buttons=4.0,
        shifter_buttons=128.0, hat_x=-1.0, hat_y=1.0, wheel_age_ticks=0.0, pedals_age_ticks=0.0,
        shifter_age_ticks=0.0, handbrake_age_ticks=0.0,
    )  # fmt: skip


def test_between_messages_the_newest_is_held_and_grows_old(rows: Callable[..., list[DeviceSample]]) -> None:
    found = rows(*(joy(at, [value], []) for at, value in ((8_000_000, 0.1), (19_000_000, 0.2), (24_000_000, 0.3))),
        axes="wheel=0", buttons="")  # fmt: skip
    assert found[0] == NO_SAMPLE
    assert [round(sample.wheel_axis, 3) for sample in found[1:]] == [0.1, 0.1, 0.1, 0.2, 0.3]
    assert [sample.pedals_age_ticks for sample in found] == [NEVER_TICKS, 0.0, 1.0, 2.0, 0.0, 0.0]


def test_a_wall_clock_s_bag_begins_with_its_first_message(rows: Callable[..., list[DeviceSample]]) -> None:
    found = rows(joy(EPOCH_NS, [0.5], []), joy(EPOCH_NS + 8_000_000, [0.75], []), axes="wheel=0", buttons="")
    assert [sample.wheel_axis for sample in found] == [0.5, 0.75]


def test_a_mapping_turns_axes_round_and_leaves_released_what_is_missing(
    rows: Callable[..., list[DeviceSample]],
) -> None:
    (sample,) = rows(joy(0, [-0.5, 0.25], [1, 0, 1]), axes="wheel=-0,brake=1", buttons="shifter=1:2")
    assert (sample.wheel_axis, sample.brake_axis) == (0.5, 0.25)
    assert (sample.throttle_axis, sample.clutch_axis) == (1.0, 1.0), "released, as the profile says"
    assert (sample.wheel_buttons, sample.shifter_buttons) == (0.0, 2.0)


@pytest.mark.parametrize("axes", ["", "wheel", "wheel=", "pedal=1", "wheel=0;brake=1", "wheel=1000"])
def test_what_is_no_mapping_of_axes_is_refused(cockpit: CockpitProfile, axes: str) -> None:
    with pytest.raises(ProfileError, match=r"--axes: value .*: NAME=PLACE or NAME=-PLACE, of wheel, throttle"):
        joy_mapping(axes, None, cockpit)


@pytest.mark.parametrize("buttons", ["wheel", "wheel=0", "lever=0:3", "wheel=0:25"])
def test_what_is_no_mapping_of_buttons_is_refused(cockpit: CockpitProfile, buttons: str) -> None:
    with pytest.raises(ProfileError, match=r"--buttons: value .*: wheel=FIRST:NUMBER"):
        joy_mapping(None, buttons, cockpit)


@pytest.mark.parametrize(
    ("message", "wrong"),
    [
        (joy(0, [0.0], []), r"message 1: axes: 1 of them, and throttle_axis shall be number 1"),
        (joy(0, OWN, []), r"message 1: buttons: 0 of them, wheel_buttons shall be 0 to 12"),
        (joy(0, (2.0, *OWN[1:]), [0] * 23), r"message 1: axes\[0\]: value 2: -1 to 1"),
        (joy(0, (float("nan"), *OWN[1:]), [0] * 23), r"message 1: axes\[0\]: value nan: -1 to 1"),
        (joy(10**16, OWN, [0] * 23), r"message 1: 10000000000000000 ns: within 86400 s"),
    ],
)
def test_a_message_that_does_not_fit_is_named(
    rows: Callable[..., list[DeviceSample]], message: Written, wrong: str
) -> None:
    with pytest.raises(RecordingError, match=wrong):
        rows(message)


def test_a_trace_is_what_drive_plays(tmp_path: Path, cockpit: CockpitProfile) -> None:
    bag = write_bag(tmp_path / "drive.bag", [joy(4_000_000 * tick, OWN, [0] * 23) for tick in range(1, 11)])
    path, told = tmp_path / "trace.csv", list[int]()
    mapping = joy_mapping(None, None, cockpit)
    assert write_trace(bag, path, mapping, tick_hz=HZ, cockpit="t500rs_th8rs", on_tick=told.append) == 10
    assert told == list(range(1, 11))
    source = TraceSource(path, tick_hz=HZ)
    assert source.header.cockpit == "t500rs_th8rs"
    assert source.poll(1).wheel_axis == 0.5
    source.close()


def test_a_joystick_is_chosen_where_there_are_several(tmp_path: Path, cockpit: CockpitProfile) -> None:
    mapping = joy_mapping("wheel=0", "", cockpit)
    several = write_bag(tmp_path / "several", [joy(0, [0.1], topic="/left"), joy(0, [0.2], topic="/right")])
    none = write_bag(tmp_path / "none", [said(0, "mark")])
    write_trace(several, tmp_path / "t.csv", mapping, tick_hz=HZ, cockpit="c", topic="/right")
    assert "0.2" in (tmp_path / "t.csv").read_text()
    for bag, topic, wrong in (
        (several, None, "value /left, /right: --topic with one of /left, /right"),
        (several, "/front", "value /front: --topic with one of"),
        (none, None, "value none: a topic of type sensor_msgs/msg/Joy"),
    ):
        with pytest.raises(RecordingError, match=wrong):
            write_trace(bag, tmp_path / "other.csv", mapping, tick_hz=HZ, cockpit="c", topic=topic)
    assert not (tmp_path / "other.csv").exists()
