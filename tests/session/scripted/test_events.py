import numpy as np
import pytest

from simconsole.profiles.faults import EdgeName
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Event, Mode
from tests.session.scripted.drives import ASKS, ENGAGED, driven, scenario

TWIST = """\
messages:
  - {{at_s: 0.2, topic: /cmd_vel, period_ms: 20, {until}message: {{linear: {{x: 4.0}}, angular: {{z: 0.1}}}}}}
events:
  - {{event: request_autonomous, at_s: 1.0}}
"""


def test_every_edge_has_its_name() -> None:
    names = set(EdgeName.__args__)  # type: ignore[attr-defined]  # an alias of Literal
    assert names == {event.name.lower() for event in Event if event.name is not None}


@pytest.mark.parametrize(
    ("trigger", "column", "limit"),
    [
        ("at_distance_m: 12", "vehicle.distance_m", 12.0),
        ("above_mps: 5", "vehicle.vx_mps", 5.0),
        ("near: {x_m: 20, y_m: 0, radius_m: 5}", "vehicle.x_m", 15.0),
    ],
)
def test_an_edge_comes_in_the_tick_after_what_triggers_it(trigger: str, column: str, limit: float) -> None:
    drive = driven(f"{ENGAGED}events:\n{ASKS}  - {{event: mark, {trigger}}}\n")
    (tick,) = drive.ticks_of(Event.MARK)
    values = drive.column(column)
    assert values[tick - 3] < limit <= values[tick - 2]


def test_an_edge_follows_another_and_a_mode() -> None:
    drive = driven(
        f"{ENGAGED}events:\n{ASKS}  - {{event: request_takeover, on_mode: autonomous, delay_s: 2}}\n"
        "  - {event: mark, on_event: request_takeover}\n"
    )
    began = int(np.flatnonzero(drive.column("arbitration.mode") == Mode.AUTONOMOUS)[0]) + 1
    assert drive.ticks_of(Event.REQUEST_TAKEOVER) == [began + 1 + 500]
    assert drive.ticks_of(Event.MARK) == [began + 2 + 500]
    assert drive.column("arbitration.mode")[began + 502] == Mode.TAKEOVER_REQUESTED


def test_time_stands_until_the_scenario_starts_it() -> None:
    edges = "  - {event: pause, at_s: 2}\n"
    drive = driven(f"{ENGAGED}events:\n{ASKS}{edges}  - {{event: start, on_event: pause}}\n")
    assert drive.ticks_of(Event.PAUSE) == [500]
    assert drive.ticks_of(Event.START) == [501]
    assert len(drive.rows) == 2000
    assert drive.problems == []
    ended = driven(f"{ENGAGED}events:\n{ASKS}{edges}")
    assert len(ended.rows) == 500, "nobody starts it: the drive ends"
    assert ended.problems == ["tick 500: simulated time stands after it and nobody starts it"]


@pytest.mark.parametrize(
    "pauses",
    [
        "messages: [{at_s: 1.0, topic: /console/request, message: {data: pause}}]\n",
        "script: {points: [{time_s: 0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0},"
        " {time_s: 1, press: [pause]}]}\n",
    ],
    ids=["message", "button"],
)
def test_a_pause_without_an_event_ends_the_drive_too(pauses: str) -> None:
    drive = driven(pauses, seconds=3)
    assert 249 <= len(drive.rows) <= 253
    assert drive.problems == [f"tick {len(drive.rows)}: simulated time stands after it and nobody starts it"]


def test_a_session_that_waits_for_its_start_is_started_by_an_event() -> None:
    waits = "  mode: {start: on_request}\n"
    drive = driven(f"{waits}events: [{{event: start, on_event: pause}}]\n", seconds=1)
    assert (drive.ticks_of(Event.PAUSE), drive.ticks_of(Event.START)) == ([1], [2])
    assert (len(drive.rows), drive.problems) == (250, [])
    assert len(driven(waits, seconds=1).rows) == 1


def test_messages_go_through_the_consoles_decoder() -> None:
    drive = driven(TWIST.format(until="for_s: 5, "))
    assert drive.problems == []
    assert drive.column("vehicle.vx_mps")[5 * 250] == pytest.approx(4.0, abs=0.3)
    assert drive.column("vehicle.yaw_rad")[5 * 250] > 0.05
    assert drive.column("arbitration.mode")[-1] in (Mode.MINIMAL_RISK, Mode.STOPPED), "it went silent after 5.2 s"
    assert driven(TWIST.format(until="for_s: 5, ")).digest == drive.digest


def test_what_the_console_refuses_is_told_and_counted() -> None:
    drive = driven(
        "messages:\n  - {at_s: 1, topic: /cmd_vel, message: {linear: {x: fast}}}\n"
        "  - {at_s: 2, topic: /cmd_vel, message: {linear: {x: 1.0, up: 3}}}\n",
        seconds=3,
    )
    assert len(drive.problems) == 1
    assert drive.problems[0].startswith("messages: /cmd_vel: tick 250: refused: ")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (ENGAGED + "messages: [{at_s: 1, topic: /cmd_vel, message: {}}]\n", "messages: without `remote`"),
        ("actors: [{name: a, gap_m: 20}]\n", "actors: gap_m: a: a world with a route, or x_m and y_m"),
        ("actors: [{name: a, x_m: 20, y_m: 0}, {name: a, x_m: 9, y_m: 0}]\n", "name: value a: another name for each"),
        (
            "actors: [{name: a, x_m: 20, y_m: 0, acts: [{above_mps: 1, of: b, speed_kmh: 0}]}]\n",
            "actors: value b: one of a",
        ),
    ],
)
def test_inputs_that_do_not_fit_are_refused(text: str, told: str) -> None:
    with pytest.raises(ProfileError, match=told):
        driven(text)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("events: [{event: mark}]\n", "no trigger given, must be exactly one of at_s"),
        ("events: [{event: mark, at_s: 1, above_mps: 2}]\n", "at_s and above_mps given"),
        ("events: [{event: explode, at_s: 1}]\n", 'value "explode"'),
        ("actors: [{name: a}]\n", "gap_m, or x_m and y_m, must be given"),
        ("actors: [{name: a, x_m: 1}]\n", "gap_m, or x_m and y_m, must be given"),
        ("actors: [{name: a, gap_m: 9, acts: [{at_s: 1}]}]\n", "no act given"),
        ("actors: [{name: a, gap_m: 9, acts: [{at_s: 1, speed_kmh: 1, lateral_m: 2}]}]\n", "speed_kmh and lateral_m"),
        (
            "actors: [{name: a, gap_m: 9, acts: [{at_s: 1, trajectory: [{time_s: 1, x_m: 0, y_m: 0},"
            " {time_s: 1, x_m: 1, y_m: 0}]}]}]\n",
            "each time_s must be later",
        ),
    ],
)
def test_what_cannot_be_meant_is_refused_with_its_key(text: str, told: str) -> None:
    with pytest.raises(ProfileError, match=told):
        scenario(text)
