from typing import Any

import pytest

from simconsole.hud.draw import bounds
from simconsole.hud.layout import layout
from simconsole.hud.view import HudView
from tests.hud.pictures import SCREEN, by_role, said, shape_of, texts


@pytest.mark.parametrize("pedal", ["clutch", "brake", "throttle"])
def test_a_pedal_bar_is_as_high_as_the_pedal_is_deep(pedal: str) -> None:
    role = "gas" if pedal == "throttle" else pedal
    slot = bounds(by_role(layout(HudView(), SCREEN), f"pedal.{role}.slot")[0])
    feet: dict[str, Any] = {pedal: 0.5}
    half = layout(HudView()._replace(**feet), SCREEN)
    bar = bounds(by_role(half, f"pedal.{role}.bar")[0])
    assert bar.h == pytest.approx(0.5 * slot.h)
    assert bar.bottom == pytest.approx(slot.bottom)
    assert by_role(half, f"pedal.{role}.number")[0].text == "50"  # type: ignore[union-attr]
    assert not by_role(layout(HudView(), SCREEN), f"pedal.{role}.bar")
    feet = {f"driver_{pedal}": 1.0}
    foot = bounds(by_role(layout(HudView()._replace(**feet), SCREEN), f"pedal.{role}.foot")[0])
    assert foot.cy == pytest.approx(slot.y)


@pytest.mark.parametrize(
    ("age_s", "words", "age"),
    [
        (None, "NONE", "no command yet"),
        (0.02, "LIVE", "20 ms old"),
        (0.3, "SILENT", "300 ms old"),
        (60.0, "SILENT", "over 10 s old"),
    ],
)
def test_the_link_is_shown_in_words_shape_and_age(age_s: float | None, words: str, age: str) -> None:
    view = HudView(link_age_s=age_s)
    assert said(view, "link") == [words]
    assert said(view, "link.age") == [age]
    assert by_role(layout(view, SCREEN), "link.shape")


def test_link_states_differ_by_shape() -> None:
    shapes = set()
    for age_s in (None, 0.02, 0.3):
        items = by_role(layout(HudView(link_age_s=age_s), SCREEN), "link.shape")
        shapes.add(tuple(shape_of(item) for item in items))
    assert len(shapes) == 3


def test_a_lost_device_is_named_with_a_warning_shape() -> None:
    items = layout(HudView(wheel_validity=2.0, pedals_validity=4.0, shifter_validity=3.0), SCREEN)
    assert [t.text for t in texts(items) if t.role == "status.pedals.label"] == ["lost"]
    assert [t.text for t in texts(items) if t.role == "status.wheel.label"] == ["live"]
    assert len(by_role(items, "status.pedals.lamp")) == len(by_role(items, "status.shifter.lamp")) == 3
    assert len(by_role(items, "status.wheel.lamp")) == 1


@pytest.mark.parametrize(
    ("validity", "pulled", "words", "warned"),
    [
        (2.0, 0.0, "off", False),
        (2.0, 1.0, "on", True),
        (3.0, 0.0, "stale", True),
        (4.0, 0.0, "lost", True),
        (4.0, 1.0, "lost", True),
        (0.0, 0.0, "let go", True),
    ],
)
def test_a_handbrake_that_commands_nothing_is_warned_of(
    validity: float, pulled: float, words: str, warned: bool
) -> None:
    items = layout(HudView(wheel_validity=2.0, handbrake_validity=validity, handbrake=pulled), SCREEN)
    assert [t.text for t in texts(items) if t.role == "status.hand_brake.label"] == [words]
    assert bool(by_role(items, "status.hand_brake.lamp")) == warned


def test_nobody_is_told_to_let_go_where_nobody_sits() -> None:
    items = layout(HudView(), SCREEN)
    assert [t.text for t in texts(items) if t.role == "status.hand_brake.label"] == ["off"]


def test_steering_left_is_drawn_to_the_left() -> None:
    left = bounds(by_role(layout(HudView(hand_wheel_deg=90.0), SCREEN), "steering.bar")[0])
    right = bounds(by_role(layout(HudView(hand_wheel_deg=-90.0), SCREEN), "steering.bar")[0])
    assert left.right == pytest.approx(right.x)
    assert said(HudView(hand_wheel_deg=90.0), "steering") == ["90 deg L"]
    assert said(HudView(hand_wheel_deg=-90.0), "steering") == ["90 deg R"]


def test_authority_is_shared_out_along_one_bar() -> None:
    items = layout(HudView(remote_lateral=0.4), SCREEN)
    person, remote = bounds(by_role(items, "share.person")[0]), bounds(by_role(items, "share.remote")[0])
    assert person.w / (person.w + remote.w) == pytest.approx(0.6)
    assert person.right == pytest.approx(remote.x)


@pytest.mark.parametrize(("force", "lamp"), [("none", 0), ("on", 1), ("eased", 0), ("limit", 3), ("lost", 3)])
def test_force_feedback_is_told_in_words_with_a_warning_where_it_is_cut_off(force: str, lamp: int) -> None:
    items = layout(HudView(force=force), SCREEN)
    assert [t.text for t in texts(items) if t.role == "status.force.label"] == [force]
    assert len(by_role(items, "status.force.lamp")) == lamp


def test_bus_that_is_down_warns_and_none_is_not_shown() -> None:
    assert said(HudView(can_up=False), "status.can.label") == ["down"]
    assert said(HudView(can_up=True), "status.can.label") == ["on"]
    assert said(HudView(can_up=None), "status.can.label") == []


@pytest.mark.parametrize(
    ("link", "lamp"),
    [
        ("nobody", 0),
        ("1 client", 1),
        ("64 clients", 1),
        ("commander", 1),
        ("lost", 3),
        ("connecting", 3),
        ("retrying", 3),
        ("down", 3),
    ],
)
def test_link_is_told_in_words_with_a_warning_where_nobody_is_left(link: str, lamp: int) -> None:
    items = layout(HudView(link=link), SCREEN)
    assert said(HudView(link=link), "status.link.label") == [link]
    assert len(by_role(items, "status.link.lamp")) == lamp
    assert said(HudView(link=link, stale=True), "status.link.label") == ["--"]
    assert said(HudView(link=None), "status.link.label") == []
