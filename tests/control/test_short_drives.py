"""Short drives that hypothesis makes up, and shortens to the fewest acts where one breaks a rule."""

import math
from collections.abc import Callable
from typing import Any

from hypothesis import HealthCheck, given, note
from hypothesis import settings as effort
from hypothesis import strategies as st

from simconsole.control.gate import limits_of
from simconsole.values.signals import Event, Mode, RemoteKind, Validity

ANY = st.floats(allow_nan=True, allow_infinity=True, width=64)
PEDAL = st.floats(0.0, 1.0)
ACTS = st.one_of(
    st.tuples(st.just("event"), st.sampled_from([event for event in Event if event])),
    st.tuples(st.just("steer"), st.floats(-0.6, 0.6)),
    st.tuples(st.just("throttle"), PEDAL),
    st.tuples(st.just("brake"), PEDAL),
    st.tuples(st.just("wheel"), st.sampled_from(list(Validity))),
    st.tuples(st.just("command"), st.tuples(st.sampled_from(list(RemoteKind)), ANY, ANY)),
    st.tuples(st.just("silence"), st.none()),
    st.tuples(st.just("refuse"), st.integers(1, 6)),
    st.tuples(st.just("speed"), st.floats(0.0, 40.0)),
    st.tuples(st.just("wait"), st.integers(1, 80)),
)


def act(rig: Any, kind: str, value: Any) -> Event | int:
    """Do one act on the rig, and return the event that it is, if it is one."""
    if kind == "event":
        return Event(value)
    if kind == "steer":
        rig.driver = rig.driver._replace(hand_wheel_rad=value * 15.0)
    elif kind in ("throttle", "brake"):
        rig.driver = rig.driver._replace(**{kind: value})
    elif kind == "wheel":
        rig.driver = rig.driver._replace(wheel_validity=float(value))
    elif kind == "command":
        rig.send(value[0], road_wheel_rad=value[1], accel_mps2=value[2])
    elif kind == "silence":
        rig.sending = False
    elif kind == "refuse":
        rig.refuse(value)
    elif kind == "speed":
        rig.vehicle = rig.vehicle._replace(vx_mps=value)
    return 0


@effort(max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(st.sampled_from(list(Mode)), st.sampled_from([50, 250, 1000]), st.lists(ACTS, max_size=25))
def test_the_rules_hold_in_any_short_drive(
    make_rig: Callable[..., Any], start: Mode, tick_hz: int, acts: list[tuple[str, Any]]
) -> None:
    rig = make_rig(tick_hz).drive(start)
    for kind, value in acts:
        note(f"{rig.mode.name}: {kind} {value!r}")
        event = act(rig, kind, value)
        for count in range(value if kind == "wait" else 1):
            mode, angle = rig.mode, rig.command.road_wheel_rad
            rig.tick(event if count == 0 else 0)
            assert all(math.isfinite(number) for number in rig.command)
            assert all(0.0 <= pedal <= 1.0 for pedal in (rig.command.throttle, rig.command.brake))
            most = limits_of(float(rig.mode), rig.settings).road_wheel_radps * rig.tick_s
            assert abs(rig.command.road_wheel_rad - angle) <= most + 1e-12
            assert 0.0 <= rig.arbitration.remote_lateral <= 1.0
            assert 0.0 <= rig.arbitration.remote_longitudinal <= 1.0
            if event == Event.EMERGENCY_STOP and count == 0:
                assert rig.mode is Mode.EMERGENCY_STOP, f"from {mode.name}"
            if rig.mode is Mode.AUTONOMOUS and mode not in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED):
                assert event == Event.REQUEST_AUTONOMOUS, f"engaged from {mode.name} without being asked"
