import msgspec

from simconsole.bridge.console.operator_acts import Act
from simconsole.scene.operator_acts import act_entry


def test_an_act_is_told_with_its_words() -> None:
    act = Act(tick=500, act="mark", note="cut in", participant="P7")
    assert act_entry(msgspec.json.encode(act), 250) == (2_000_000_000, "INFO", "operator: mark, participant P7, cut in")
    assert act_entry(msgspec.json.encode(Act(tick=1, act="pause")), 250).text == "operator: pause"


def test_what_is_no_act_does_not_end_the_scene() -> None:
    assert act_entry(b"{", 250).level == "WARN"
