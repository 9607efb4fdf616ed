"""Stories, maneuvers and events: which of them are understood, and whose parameters count in them."""

import pytest

from simconsole.evaluation.openscenario.importing import imported
from simconsole.values.errors import ProfileError
from tests.evaluation.openscenario.files import UNDERSTOOD, brakes, written


@pytest.mark.parametrize("priority", ["skip", "parallel", "override"])
def test_a_priority_that_nobody_keeps_to_is_refused(priority: str) -> None:
    """One event alone has nobody to skip; of several, each act replaces the one before."""
    alone = written(brakes()).replace(b'priority="override"', f'priority="{priority}"'.encode())
    assert len(imported(alone, "made.xosc").profile.actors[0].acts) == 1
    several = written(brakes(), events=2).replace(b'priority="override"', f'priority="{priority}"'.encode())
    if priority == "override":
        assert len(imported(several, "made.xosc").profile.actors[0].acts) == 2
        return
    with pytest.raises(ProfileError, match="<Event>: not understood: priority override, of several events"):
        imported(several, "made.xosc")
    assert imported(several, "made.xosc", partly=True).profile.actors[0].acts == ()


def test_a_parameter_counts_in_the_story_or_maneuver_that_declares_it() -> None:
    def speeds_kmh(content: bytes, **given: str) -> list[float | None]:
        return [act.speed_kmh for act in imported(content, "made.xosc", parameters=given).profile.actors[0].acts]

    asked = b'AbsoluteTargetSpeed value="$speed"'
    content = UNDERSTOOD["speed by time"]().replace(b'AbsoluteTargetSpeed value="0.0"', asked)
    assert speeds_kmh(content) == [pytest.approx(21.6)]
    assert speeds_kmh(content, speed="2") == [pytest.approx(7.2)]
    own = b'<ParameterDeclaration name="speed" parameterType="double" value="%s"/>'
    own = b"<ParameterDeclarations>" + own + b"</ParameterDeclarations>"
    in_story = content.replace(b'<Story name="story">', b'<Story name="story">' + own % b"3")
    assert speeds_kmh(in_story, speed="2") == [pytest.approx(10.8)]
    in_maneuver = in_story.replace(b'<Maneuver name="maneuver">', b'<Maneuver name="maneuver">' + own % b"4")
    assert speeds_kmh(in_maneuver) == [pytest.approx(14.4)]
    later = in_story.replace(b"<StopTrigger>", b'<Story name="late"/><StopTrigger>', 1)
    assert speeds_kmh(later) == [pytest.approx(10.8)]
