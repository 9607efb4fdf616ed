from typing import Any

import pytest

from simconsole.bridge.console.output_schedule import OutputSchedule, topic_names
from simconsole.bridge.console.topics import CLOCK, ODOMETRY, TF_STATIC, Outputs
from simconsole.bridge.messages import standard_registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError


def schedule(**profile: Any) -> OutputSchedule:
    made = BridgeProfile(**profile)
    outputs = Outputs(standard_registry(), made).topics()
    return OutputSchedule(outputs, topic_names(made, [output.name for output in outputs]), made)


def test_each_topic_is_due_at_its_rate_and_a_latched_one_once(snapshot: Any) -> None:
    planned = schedule()
    due = [output.name for tick in range(1, 251) for output in planned.due(snapshot(tick))]
    counts = {name: due.count(name) for name in (CLOCK, ODOMETRY, TF_STATIC)}
    assert counts == {CLOCK: 100, ODOMETRY: 50, TF_STATIC: 1}


def test_odometry_comes_where_it_is_asked_for(snapshot: Any) -> None:
    planned = schedule()
    assert ODOMETRY not in [output.name for output in planned.due(snapshot(1))]
    assert [output.name for output in planned.due(snapshot(2), odometry=True)][-1] == ODOMETRY


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
