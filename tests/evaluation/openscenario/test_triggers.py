"""When an act comes: the edges of conditions, and what they become."""

import pytest

from simconsole.evaluation.openscenario.importing import imported
from simconsole.values.errors import ProfileError
from tests.evaluation.openscenario.files import UNDERSTOOD, brakes, by, written, xosc


@pytest.mark.parametrize(
    ("name", "edge", "told"),
    [
        ("own speed", "falling", "conditionEdge rising or none"),
        ("own speed", "risingOrFalling", "conditionEdge rising or none"),
        ("a speed below", "none", "conditionEdge rising, of a speed below a limit"),
        ("a condition and a time", "rising", "conditionEdge none, of a time beside another condition"),
    ],
)
def test_an_edge_that_no_trigger_has_is_refused(name: str, edge: str, told: str) -> None:
    slow = xosc().SpeedCondition(5, xosc().Rule.lessThan)
    content = written(brakes(), by(slow)) if name == "a speed below" else UNDERSTOOD[name]()
    before = b"none" if name == "a condition and a time" else b"rising"
    assert imported(content, "made.xosc").profile.actors[0].acts
    content = content.replace(b'conditionEdge="' + before, f'conditionEdge="{edge}'.encode())
    with pytest.raises(ProfileError, match=f"<Condition>: not understood: {told}"):
        imported(content, "made.xosc")
    assert imported(content, "made.xosc", partly=True).profile.actors[0].acts == ()


def test_edges_arrive() -> None:
    rises = imported(UNDERSTOOD["a distance"](), "made.xosc").profile.actors[0].acts[0]
    content = UNDERSTOOD["a distance"]().replace(b'"rising"', b'"none"')
    assert (rises.rising, imported(content, "made.xosc").profile.actors[0].acts[0].rising) == (True, False)
