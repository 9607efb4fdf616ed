from itertools import combinations, pairwise

import pytest

from simconsole.hud.draw import ACTIVE, CAUTION, DANGER, TEXT, Colour, Text, bounds
from simconsole.hud.layout import layout, places
from simconsole.hud.view import HudView
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from tests.hud.pictures import SCREEN, SCREENS, asked, by_role, colours, in_mode, said


@pytest.mark.parametrize("mode", Mode)
def test_the_mode_is_always_shown_in_words_and_shape_at_one_place(mode: Mode) -> None:
    items = layout(in_mode(mode, refusal_label="refused: too fast"), SCREEN)
    (words,) = by_role(items, "mode.label")
    assert isinstance(words, Text)
    assert words.text == mode_label(mode)
    place = places(SCREEN).banner
    shapes = by_role(items, "mode.shape")
    assert shapes
    for item in (words, *shapes):
        box = bounds(item)
        assert place.y <= box.y
        assert box.bottom <= place.bottom
    assert all(bounds(shape).right < words.x for shape in shapes)
    assert abs(words.x - by_role(layout(in_mode(Mode.MANUAL), SCREEN), "mode.label")[0].x) < 1e-9  # type: ignore[union-attr]


def test_the_labels_fit_their_alert_rules() -> None:
    for view in (asked(1), asked(2), in_mode(Mode.MINIMAL_RISK), in_mode(Mode.EMERGENCY_STOP), HudView(stale=True)):
        alert = said(view, "alert.label") + said(view, "alert.todo")
        assert 1 <= len(" ".join(alert).split()) <= 7, alert


def test_a_take_over_spans_every_screen_and_counts_down_on_each() -> None:
    screen = SCREENS["triple"]
    items = layout(asked(1), screen)
    (field,) = by_role(items, "alert")
    assert bounds(field).w == screen.safe().w
    counted = by_role(items, "alert.countdown")
    assert [item.text for item in counted if isinstance(item, Text)] == ["8", "8", "8"]
    thirds = [int(item.x // (screen.width_px / 3)) for item in counted if isinstance(item, Text)]
    assert sorted(thirds) == [0, 1, 2]


def test_the_second_stage_is_red_and_flashes_between_one_and_five_hertz() -> None:
    first = {frozenset(colours(layout(asked(1, t_s=0.01 * i), SCREEN), "alert")) for i in range(200)}
    assert first == {frozenset({CAUTION})}
    seen = [colours(layout(asked(2, t_s=0.01 * i), SCREEN), "alert").pop() for i in range(200)]
    assert set(seen) == {DANGER, TEXT}
    changes = sum(a != b for a, b in pairwise(seen))
    assert 1.0 <= changes / 2.0 / 2.0 <= 5.0


def test_the_countdown_is_a_number_and_a_shrinking_bar() -> None:
    widths = []
    for remaining_s in (10.0, 6.1, 0.0):
        items = layout(asked(1, remaining_s=remaining_s), SCREEN)
        bars = by_role(items, "alert.bar")
        widths.append(bounds(bars[0]).w if bars else 0.0)
    assert widths[0] > widths[1] > widths[2] == 0.0
    assert said(asked(1, remaining_s=6.1), "alert.countdown") == ["7"]
    assert said(asked(1, remaining_s=0.0), "alert.countdown") == ["0"]


def test_only_the_strongest_alert_is_shown() -> None:
    held = {"notice_label": "throttle is held: autopilot only steers"}
    assert said(in_mode(Mode.AUTONOMOUS, **held), "alert.label") == [held["notice_label"]]
    refusal = {"refusal_label": "refused: too fast", **held}
    assert said(in_mode(Mode.MANUAL, **refusal), "alert.label") == ["refused: too fast"]
    assert said(asked(1, **refusal), "alert.label") == ["TAKE OVER"]
    assert said(in_mode(Mode.MINIMAL_RISK, **refusal), "alert.label") == ["CAR IS STOPPING"]
    assert said(in_mode(Mode.EMERGENCY_STOP, **refusal), "alert.label") == ["EMERGENCY STOP"]
    assert said(asked(2, stale=True, **refusal), "alert.label") == ["NO DATA"]


def _deuteranope(colour: Colour) -> tuple[float, float, float]:
    """Machado, Oliveira and Fernandes 2009, deuteranopia, severity 1; on gamma-encoded values for a coarse check."""
    r, g, b = colour
    return (
        0.367322 * r + 0.860646 * g - 0.227968 * b,
        0.280085 * r + 0.672501 * g + 0.047413 * b,
        -0.011820 * r + 0.042940 * g + 0.968881 * b,
    )


def test_alert_colours_stay_apart_for_a_deuteranope() -> None:
    for one, other in combinations((TEXT, ACTIVE, CAUTION, DANGER), 2):
        a, b = _deuteranope(one), _deuteranope(other)
        distance = sum((x - y) ** 2 for x, y in zip(a, b, strict=True)) ** 0.5
        assert distance > 60.0, (one, other)


def test_a_failed_recording_is_told_to_the_end_and_hides_no_answer() -> None:
    failed = in_mode(Mode.MANUAL, recording_failed=True)
    assert said(failed, "alert.label") == ["RECORDING FAILED"]
    assert said(failed, "alert.todo") == ["drive is not kept"]
    held = failed._replace(notice_label="throttle is held: autopilot only steers")
    assert said(held, "alert.todo") == [held.notice_label]
    refused = held._replace(refusal_label="refused: too fast")
    assert said(refused, "alert.todo") == ["refused: too fast"]
    assert said(asked(1, recording_failed=True), "alert.label") == ["TAKE OVER"], "what saves the car comes first"
