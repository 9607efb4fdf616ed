import subprocess
import sys
from itertools import combinations, pairwise

import pytest

from simconsole.errors import ProfileError
from simconsole.hud.draw import (
    ACTIVE,
    CAUTION,
    DANGER,
    PALETTE,
    TEXT,
    WARNING_LINE,
    Box,
    Colour,
    DrawItem,
    Polygon,
    Rect,
    Text,
    bounds,
    luminance,
)
from simconsole.hud.layout import check_screen, layout, places, sample_views
from simconsole.hud.screen import Screen
from simconsole.hud.view import HudView
from simconsole.signals import Mode
from simconsole.words import mode_words

SCREENS = {
    "4:3": Screen(1400, 1050, 1.6, 2.2),
    "16:9": Screen(1920, 1080, 1.6, 2.0),
    "triple": Screen(4200, 1050, 4.8, 2.2),
}
SCREEN = SCREENS["4:3"]

every_screen = pytest.mark.parametrize("screen", SCREENS.values(), ids=SCREENS)


def in_mode(mode: Mode, **more: object) -> HudView:
    return HudView(mode=float(mode), mode_words=mode_words(mode), reason_words="driver asked")._replace(**more)


def asked(stage: int, **more: object) -> HudView:
    return in_mode(Mode.TAKEOVER_REQUESTED, takeover_stage=stage, **{"remaining_s": 7.2, **more})


def texts(items: list[DrawItem]) -> list[Text]:
    return [item for item in items if isinstance(item, Text)]


def by_role(items: list[DrawItem], role: str) -> list[DrawItem]:
    return [item for item in items if item.role == role]


def said(view: HudView, role: str) -> list[str]:
    return [item.text for item in texts(layout(view, SCREEN)) if item.role == role]


@every_screen
def test_nothing_is_within_five_percent_of_the_border(screen: Screen) -> None:
    for view in sample_views():
        for item in layout(view, screen):
            box = bounds(item)
            if item.role == "ground":
                continue
            assert box.x >= 0.05 * screen.width_px, item
            assert box.right <= 0.95 * screen.width_px, item
            assert box.y >= 0.05 * screen.height_px, item
            assert box.bottom <= 0.95 * screen.height_px, item


@every_screen
def test_every_text_is_large_enough_for_the_seat(screen: Screen) -> None:
    check_screen(screen, "hud")
    for view in sample_views():
        for item in texts(layout(view, screen)):
            assert item.arcmin in (16.0, 20.0, 60.0)
            assert item.cap_px / screen.px_per_arcmin >= item.arcmin
            if item.role == "speed" and item.text != "NO DATA":
                assert item.arcmin == 60.0
            if item.role.startswith(("mode", "reason", "alert", "gear", "link.words")) and "automatic" not in item.role:
                assert item.arcmin >= 20.0


@every_screen
def test_no_two_texts_touch(screen: Screen) -> None:
    for view in sample_views():
        for one, other in combinations(texts(layout(view, screen)), 2):
            a, b = bounds(one), bounds(other)
            apart = a.right <= b.x or b.right <= a.x or a.bottom <= b.y or b.bottom <= a.y
            assert apart, (one, other)


def test_pixels_per_degree_are_those_of_the_reference_seat() -> None:
    # 1400 px on 1.6 m at 2.2 m are 34 px per degree.
    assert SCREEN.px_per_arcmin * 60.0 == pytest.approx(34.0, abs=0.5)


def test_a_seat_too_far_away_fails_at_start_up() -> None:
    with pytest.raises(ProfileError, match=r"bench\.yaml: screen_width_m 1.6 at eye_distance_m 6 .*arc minutes"):
        check_screen(Screen(1400, 1050, 1.6, 6.0), "bench.yaml")


@pytest.mark.parametrize("mode", Mode)
def test_the_mode_is_always_shown_in_words_and_shape_at_one_place(mode: Mode) -> None:
    items = layout(in_mode(mode, refusal_words="refused: too fast"), SCREEN)
    (words,) = by_role(items, "mode.words")
    assert isinstance(words, Text)
    assert words.text == mode_words(mode)
    place = places(SCREEN).banner
    shapes = by_role(items, "mode.shape")
    assert shapes
    for item in (words, *shapes):
        box = bounds(item)
        assert place.y <= box.y
        assert box.bottom <= place.bottom
    assert all(bounds(shape).right < words.x for shape in shapes)
    assert abs(words.x - by_role(layout(in_mode(Mode.MANUAL), SCREEN), "mode.words")[0].x) < 1e-9  # type: ignore[union-attr]


def test_modes_differ_by_shape_and_not_only_by_colour() -> None:
    shapes = {}
    for mode in Mode:
        items = by_role(layout(in_mode(mode), SCREEN), "mode.shape")
        shapes[mode] = tuple(tuple(v for v in item if not _is_colour(v)) for item in items)
    assert len(set(shapes.values())) == len(Mode)


def _is_colour(value: object) -> bool:
    return value in PALETTE


def test_the_words_fit_their_alert_rules() -> None:
    for view in (asked(1), asked(2), in_mode(Mode.MINIMAL_RISK), in_mode(Mode.EMERGENCY_STOP), HudView(stale=True)):
        alert = said(view, "alert.words") + said(view, "alert.todo")
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


def test_the_cluster_stands_on_the_middle_screen() -> None:
    screen = SCREENS["triple"]
    for item in layout(in_mode(Mode.MANUAL), screen):
        box = bounds(item)
        assert item.role == "ground" or (box.x >= 1400 and box.right <= 2800)


def _colours(items: list[DrawItem], role: str) -> set[Colour]:
    return {item.colour for item in items if item.role == role}


def test_the_second_stage_is_red_and_flashes_between_one_and_five_hertz() -> None:
    first = {frozenset(_colours(layout(asked(1, t_s=0.01 * i), SCREEN), "alert")) for i in range(200)}
    assert first == {frozenset({CAUTION})}
    seen = [_colours(layout(asked(2, t_s=0.01 * i), SCREEN), "alert").pop() for i in range(200)]
    assert set(seen) == {DANGER, TEXT}
    changes = sum(a != b for a, b in pairwise(seen))
    assert 1.0 <= changes / 2.0 / 2.0 <= 5.0


@pytest.mark.parametrize("mode", [Mode.PARKED, Mode.MANUAL, Mode.SHARED, Mode.AUTONOMOUS, Mode.STOPPED])
def test_nothing_else_flashes(mode: Mode) -> None:
    pictures = set()
    for hundredth in range(100):
        items = layout(in_mode(mode, t_s=10.0 + 0.0099 * hundredth), SCREEN)
        pictures.add(tuple(items))
    assert len(pictures) == 1


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
    refusal = {"refusal_words": "refused: too fast"}
    assert said(in_mode(Mode.MANUAL, **refusal), "alert.words") == ["refused: too fast"]
    assert said(asked(1, **refusal), "alert.words") == ["TAKE OVER"]
    assert said(in_mode(Mode.MINIMAL_RISK, **refusal), "alert.words") == ["CAR IS STOPPING"]
    assert said(in_mode(Mode.EMERGENCY_STOP, **refusal), "alert.words") == ["EMERGENCY STOP"]
    assert said(asked(2, stale=True, **refusal), "alert.words") == ["NO DATA"]


def test_stale_data_shows_no_data_and_no_number_of_the_drive() -> None:
    shown = HudView(
        shown_kmh=37, rpm=3210.0, gear="2", throttle=0.42, distance_m=1234.0, t_s=65.0, link_age_s=0.02,
        road_wheel_rad=0.1, mode=float(Mode.MANUAL), mode_words="MANUAL", wheel_validity=2.0, engine_running=True,
    )  # fmt: skip
    items = layout(shown._replace(stale=True), SCREEN)
    words = [item.text for item in texts(items) if item.role != "dial.number"]
    assert words.count("NO DATA") == 2
    assert "MANUAL" not in words
    assert not [text for text in words if any(c.isdigit() for c in text) and text != "x1000 rpm"]
    assert not by_role(items, "dial.needle")
    assert not by_role(items, "dial.band")
    assert "37" in [item.text for item in texts(layout(shown, SCREEN))]


def test_the_needle_follows_the_engine_over_the_whole_dial() -> None:
    tops = []
    for rpm in (0.0, 3500.0, 7000.0, 9000.0):
        (needle,) = by_role(layout(in_mode(Mode.MANUAL, rpm=rpm), SCREEN), "dial.needle")
        assert isinstance(needle, Polygon)
        tops.append(bounds(needle).cx)
    dial = places(SCREEN).dial
    assert tops[0] < dial.cx - 100
    assert tops[1] == pytest.approx(dial.cx, abs=1.0)
    assert tops[2] > dial.cx + 100
    assert tops[3] == tops[2]


def test_the_red_zone_asks_for_a_shift_in_words_and_shape() -> None:
    items = layout(in_mode(Mode.MANUAL, rpm=6200.0), SCREEN)
    assert by_role(items, "shift")
    assert by_role(items, "shift.arrow")
    assert _colours(items, "dial.needle") == {WARNING_LINE}
    assert not by_role(layout(in_mode(Mode.MANUAL, rpm=5900.0), SCREEN), "shift")
    assert not by_role(layout(in_mode(Mode.AUTONOMOUS, rpm=6200.0, automatic=True), SCREEN), "shift")


@pytest.mark.parametrize("pedal", ["clutch", "brake", "throttle"])
def test_a_pedal_bar_is_as_high_as_the_pedal_is_deep(pedal: str) -> None:
    role = "gas" if pedal == "throttle" else pedal
    slot = bounds(by_role(layout(HudView(), SCREEN), f"pedal.{role}.slot")[0])
    half = layout(HudView()._replace(**{pedal: 0.5}), SCREEN)
    bar = bounds(by_role(half, f"pedal.{role}.bar")[0])
    assert bar.h == pytest.approx(0.5 * slot.h)
    assert bar.bottom == pytest.approx(slot.bottom)
    assert by_role(half, f"pedal.{role}.number")[0].text == "50"  # type: ignore[union-attr]
    assert not by_role(layout(HudView(), SCREEN), f"pedal.{role}.bar")
    foot = bounds(by_role(layout(HudView()._replace(**{f"driver_{pedal}": 1.0}), SCREEN), f"pedal.{role}.foot")[0])
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
        shapes.add(tuple(tuple(v for v in item if not _is_colour(v)) for item in items))
    assert len(shapes) == 3


def test_a_lost_device_is_named_with_a_warning_shape() -> None:
    items = layout(HudView(wheel_validity=2.0, pedals_validity=4.0, shifter_validity=3.0), SCREEN)
    assert [t.text for t in texts(items) if t.role == "status.pedals.words"] == ["lost"]
    assert [t.text for t in texts(items) if t.role == "status.wheel.words"] == ["live"]
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
    assert [t.text for t in texts(items) if t.role == "status.hand_brake.words"] == [words]
    assert bool(by_role(items, "status.hand_brake.lamp")) == warned


def test_nobody_is_told_to_let_go_where_nobody_sits() -> None:
    items = layout(HudView(), SCREEN)
    assert [t.text for t in texts(items) if t.role == "status.hand_brake.words"] == ["off"]


def test_steering_left_is_drawn_to_the_left() -> None:
    left = bounds(by_role(layout(HudView(road_wheel_rad=0.2), SCREEN), "steering.bar")[0])
    right = bounds(by_role(layout(HudView(road_wheel_rad=-0.2), SCREEN), "steering.bar")[0])
    assert left.right == pytest.approx(right.x)
    assert said(HudView(road_wheel_rad=0.2), "steering") == ["11.5 deg L"]
    assert said(HudView(road_wheel_rad=-0.2), "steering") == ["11.5 deg R"]


def test_authority_is_shared_out_along_one_bar() -> None:
    items = layout(HudView(remote_lateral=0.4), SCREEN)
    person, remote = bounds(by_role(items, "share.person")[0]), bounds(by_role(items, "share.remote")[0])
    assert person.w / (person.w + remote.w) == pytest.approx(0.6)
    assert person.right == pytest.approx(remote.x)


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


def test_no_text_is_pure_blue_or_red() -> None:
    for view in sample_views():
        for item in texts(layout(view, SCREEN)):
            r, g, b = item.colour
            assert not (b > 128 and r < 64 and g < 64)
            assert item.colour is not WARNING_LINE
    assert luminance(DANGER) < 0.1


@every_screen
def test_panels_do_not_overlap(screen: Screen) -> None:
    for one, other in combinations(places(screen), 2):
        apart = one.right <= other.x or other.right <= one.x or one.bottom <= other.y or other.bottom <= one.y
        assert apart


def test_layout_is_pure() -> None:
    view = asked(2, t_s=1.0)
    assert layout(view, SCREEN) == layout(view, SCREEN)


def test_the_core_loads_no_graphics_library() -> None:
    program = (
        "import sys; import simconsole.hud.layout, simconsole.hud.view, simconsole.words, simconsole.keys; "
        "sys.exit(any(m in sys.modules for m in ('pygame', 'rerun', 'numba', 'matplotlib')))"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_boxes_measure_themselves() -> None:
    box = Box(10.0, 20.0, 30.0, 40.0)
    assert (box.right, box.bottom, box.cx, box.cy) == (40.0, 60.0, 25.0, 40.0)
    assert box.row(0.5, 1.0) == Box(10.0, 40.0, 30.0, 20.0)
    assert box.column(0.0, 0.5) == Box(10.0, 20.0, 15.0, 40.0)
    assert box.inset(5.0) == Box(15.0, 25.0, 20.0, 30.0)
    assert bounds(Rect(box, TEXT, "x")) == box


@pytest.mark.parametrize(("force", "warns"), [("none", 0), ("on", 0), ("limit", 1), ("lost", 1)])
def test_force_feedback_is_told_in_words_with_a_warning_where_it_is_cut_off(force: str, warns: int) -> None:
    items = layout(HudView(force=force), SCREEN)
    assert [t.text for t in texts(items) if t.role == "status.force.words"] == [force]
    assert len(by_role(items, "status.force.lamp")) == {"none": 0, "on": 1}.get(force, 3)
    assert warns == (len(by_role(items, "status.force.lamp")) == 3)


def test_bus_that_is_down_warns_and_none_is_not_shown() -> None:
    assert said(HudView(can_up=False), "status.can.words") == ["down"]
    assert said(HudView(can_up=True), "status.can.words") == ["on"]
    assert said(HudView(can_up=None), "status.can.words") == []


@pytest.mark.parametrize(
    ("link", "lamp"),
    [("nobody", 0), ("1 client", 1), ("64 clients", 1), ("commander", 1), ("lost", 3), ("retrying", 3), ("down", 3)],
)
def test_link_is_told_in_words_with_a_warning_where_nobody_is_left(link: str, lamp: int) -> None:
    items = layout(HudView(link=link), SCREEN)
    assert said(HudView(link=link), "status.link.words") == [link]
    assert len(by_role(items, "status.link.lamp")) == lamp
    assert said(HudView(link=link, stale=True), "status.link.words") == ["--"]
    assert said(HudView(link=None), "status.link.words") == []
