import math
from typing import Any

import pytest

from simconsole.bridge.console.output_schedule import OutputSchedule, topic_names
from simconsole.bridge.console.topics import CLOCK, MODE, ODOMETRY, TF_STATIC, Outputs
from simconsole.bridge.messages import standard_registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Mode


def schedule(**profile: Any) -> OutputSchedule:
    made = BridgeProfile(**profile)
    outputs = Outputs(standard_registry(), made).topics()
    return OutputSchedule(outputs, topic_names(made, [output.name for output in outputs]), made)


def test_each_topic_is_due_at_its_rate_and_a_latched_one_once(snapshot: Any) -> None:
    planned = schedule()
    due = [output.name for tick in range(1, 251) for output in planned.due(snapshot(tick))]
    counts = {name: due.count(name) for name in (CLOCK, ODOMETRY, TF_STATIC)}
    assert counts == {CLOCK: 100, ODOMETRY: 50, TF_STATIC: 1}


@pytest.mark.parametrize("period", [1, 2, 5, 7])
@pytest.mark.parametrize("rate_hz", [30.0, 10.0, 50.0, 35.7])
def test_no_message_is_lost_where_only_some_ticks_are_published(period: int, rate_hz: float, snapshot: Any) -> None:
    planned = schedule(rates_hz={CLOCK: rate_hz})
    ticks = range(period, 2501, period)
    due = [tick for tick in ticks for output in planned.due(snapshot(tick)) if output.name == CLOCK]
    # Each instant of the rate (its last tick may be the last published one) is met by the next tick that is published.
    instants = [math.ceil(count * 250 / rate_hz) for count in range(1, int(10 * rate_hz) + 1)]
    expected = sorted({math.ceil(instant / period) * period for instant in instants})
    assert due == [tick for tick in expected if tick <= ticks[-1]]


def test_odometry_comes_where_it_is_asked_for(snapshot: Any) -> None:
    planned = schedule()
    assert ODOMETRY not in [output.name for output in planned.due(snapshot(1))]
    assert [output.name for output in planned.due(snapshot(2), odometry=True)][-1] == ODOMETRY


def test_the_mode_is_due_at_first_with_each_change_and_at_its_rate(snapshot: Any) -> None:
    planned = schedule()
    (mode,) = (output for output in planned.outputs if output.name == MODE)
    assert mode.latched
    modes = {tick: Mode.MANUAL if 31 <= tick < 60 else Mode.PARKED for tick in range(1, 101)}
    due = [tick for tick in modes if mode in planned.due(snapshot(tick, mode=modes[tick]))]
    assert due == [1, 25, 31, 50, 60, 75, 100]


def test_names_and_rates_are_the_profile_s() -> None:
    planned = schedule(namespace="/ego", rename={ODOMETRY: "/pose"}, rates_hz={CLOCK: 0.0, ODOMETRY: 20.0})
    found = {output.standard: (output.name, output.rate_hz) for output in planned.outputs}
    assert CLOCK not in found
    assert found[ODOMETRY] == ("/pose", 20.0)
    assert found[TF_STATIC][0] == TF_STATIC, "never under a namespace"
    assert found["/console/joy"][0] == "/ego/console/joy"


@pytest.mark.parametrize(
    ("profile", "wrong"),
    [
        ({"rates_hz": {"/nothing": 1.0}}, r"rates_hz: /nothing is no topic"),
        ({"rename": {"/nothing": "/else"}}, r"rename: /nothing is no topic"),
        ({"rename": {ODOMETRY: "/tf"}}, r"would both be /tf"),
    ],
)
def test_what_no_topic_is_called_is_refused(profile: dict[str, Any], wrong: str) -> None:
    with pytest.raises(ProfileError, match=wrong):
        schedule(**profile)
