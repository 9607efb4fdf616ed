"""The driver's instrument cluster: `layout` turns a view into a draw list. Pure; no graphics library.

Top to bottom inside the safe area: who drives (mode as label and shape), one slot for the one alert, then pedals,
dial and steering side by side, then a strip of lamps. Each thing has one place at all times.
"""

import math
from typing import Final, NamedTuple

from simconsole.hud.advice import BAND, ONE_SPEED, PREPARE, WIDEST
from simconsole.hud.banner import ONE_SCREEN, Alert, alert_of, banner, slot
from simconsole.hud.captions import (
    ASK,
    AUTOPILOT,
    CONSOLE,
    LONGEST_BUTTON,
    MENDING,
    NOBODY,
    PRESS_TO_DRIVE,
    PRESS_TO_RESET,
    STEER_OR_BRAKE,
    WAIT,
)
from simconsole.hud.dial import dial
from simconsole.hud.draw import BACKGROUND, Box, DrawItem, Rect, Text, bounds
from simconsole.hud.guidance import Ahead
from simconsole.hud.panels import LAMPS, pedals, status, steering, who_steers
from simconsole.hud.screen import Screen
from simconsole.hud.strip import HEIGHT_ARCMIN, strip
from simconsole.hud.turn_sign import TURN_HEIGHT_ARCMIN, TURN_WIDTH_ARCMIN, turn_panel
from simconsole.hud.view import NOT_NOW, TWO_GEARS, HudSettings, HudView
from simconsole.values.errors import ProfileError
from simconsole.values.labels import (
    LINK_COMMANDER,
    LINK_CONNECTING,
    LINK_NOBODY,
    mode_label,
    notice_label,
    reason_label,
)
from simconsole.values.signals import Mode, Notice, Reason

GAP: Final = 0.02
LARGE_LAMPS: Final = 4
BANNER_ARCMIN: Final = 168.0
SLOT_ARCMIN: Final = 130.0
"""Heights under the road at which each text has the size that it needs (`check_screen`)."""


class Places(NamedTuple):
    """Where each part of the cluster stands."""

    banner: Box
    slot: Box
    left: Box | None  # the pedals, which large text leaves out
    dial: Box
    right: Box
    status: Box


class PlacesUnderView(NamedTuple):
    """Where the instruments stand that leave the road most of the screen."""

    slot: Box  # at the top, only while there is something to say
    turn: Box  # on the left below it, only on a route
    strip: Box
    banner: Box


def places(screen: Screen) -> Places:
    """Divide the driver's screen."""
    area = screen.content()
    if screen.has_large_text:
        return _places_of_large_text(area)
    middle = area.row(0.275, 0.88)
    dial_width = min(1.125 * middle.h, 0.50 * area.w)
    gap = GAP * area.h
    side = 0.5 * (area.w - dial_width) - gap
    left = Box(area.cx - 0.5 * dial_width - gap - side, middle.y, side, middle.h)
    right = Box(area.cx + 0.5 * dial_width + gap, middle.y, side, middle.h)
    return Places(
        banner=area.row(0.0, 0.135),
        slot=area.row(0.15, 0.26),
        left=left,
        dial=Box(area.cx - 0.5 * dial_width, middle.y, dial_width, middle.h),
        right=right,
        status=area.row(0.90, 1.0),
    )


def _places_of_large_text(area: Box) -> Places:
    """Divide the screen where all that is not needed to drive makes room for text."""
    middle = area.row(0.295, 0.84)
    dial_width = min(1.125 * middle.h, 0.50 * area.w)
    beside = area.x + dial_width + GAP * area.h
    return Places(
        banner=area.row(0.0, 0.14),
        slot=area.row(0.155, 0.28),
        left=None,
        dial=Box(area.x, middle.y, dial_width, middle.h),
        right=Box(beside, middle.y, area.right - beside, middle.h),
        status=area.row(0.86, 1.0),
    )


def places_under_view(screen: Screen) -> PlacesUnderView:
    """Divide the driver's screen by what must be legible: heights are angles at the driver's eye, not shares."""
    area, unit = screen.content(), screen.px_per_arcmin
    gap = GAP * area.h
    banner = Box(area.x, area.bottom - BANNER_ARCMIN * unit, area.w, BANNER_ARCMIN * unit)
    height = HEIGHT_ARCMIN * unit
    slot = Box(area.x, area.y, area.w, SLOT_ARCMIN * unit)
    return PlacesUnderView(
        slot=slot,
        turn=Box(area.x, slot.bottom + gap, TURN_WIDTH_ARCMIN * unit, TURN_HEIGHT_ARCMIN * unit),
        strip=Box(area.x, banner.y - 0.5 * gap - height, area.w, height),
        banner=banner,
    )


def layout(view: HudView, screen: Screen) -> list[DrawItem]:
    """Return everything to draw, back to front, in pixels of `screen`."""
    alert = alert_of(view)
    ground = Rect(Box(0.0, 0.0, screen.width_px, screen.height_px), BACKGROUND, "ground")
    if screen.has_view:
        under = places_under_view(screen)
        message = [] if alert is Alert.NONE else slot(view, alert, under.slot, screen)
        told = [*message, *turn_panel(view, under.turn)]
        return [ground, *strip(view, under.strip), *told, *banner(view, alert, under.banner)]
    place = places(screen)
    has_all = place.left is not None
    return [
        ground,
        *([] if place.left is None else pedals(view, place.left)),
        *dial(view, place.dial),
        *(steering(view, place.right) if has_all else who_steers(view, place.right)),
        *status(view, place.status, len(LAMPS) if has_all else LARGE_LAMPS),
        *slot(view, alert, place.slot, screen),
        *banner(view, alert, place.banner),
    ]


def panels_over_view(view: HudView, screen: Screen) -> tuple[Box, ...]:
    """Return the parts of the screen that hide the road: a message and the next turn if any, last the instruments."""
    place = places_under_view(screen)
    top = float(math.floor(place.strip.y - _pad_px(screen)))
    instruments = Box(0.0, top, screen.width_px, screen.height_px - top)
    alert = alert_of(view)
    shown = [] if alert is Alert.NONE else [_message(alert, screen)]
    if turn_panel(view, place.turn):
        shown.append(place.turn)
    return (*shown, instruments)


def message_place(screen: Screen) -> Box:
    """Return the part of the screen that a message over the road hides at most."""
    return _message(Alert.TAKE_OVER, screen)


def _message(alert: Alert, screen: Screen) -> Box:
    """Return the part of the screen that an alert hides: the strong ones span every screen."""
    safe, before_driver = screen.safe(), places_under_view(screen).slot
    spanning = Box(safe.x, before_driver.y, safe.w, before_driver.h)
    return (before_driver if alert in ONE_SCREEN else spanning).inset(-_pad_px(screen))


def _pad_px(screen: Screen) -> float:
    return 0.5 * GAP * screen.height_px


def check_screen(screen: Screen, name: str, settings: HudSettings | None = None) -> None:
    """Fail at start-up when some text would be too small to read, or something would leave the safe area.

    Args:
        screen: the screen to check.
        name: what to call its profile in the message.
        settings: what the display knows of the drive, its language among it.

    Raises:
        ProfileError: names the keys to change.
    """
    safe = screen.safe()
    for view in sample_views(settings):
        for item in layout(view, screen):
            if isinstance(item, Text) and item.cap_px < item.arcmin * screen.px_per_arcmin:
                have = item.cap_px / screen.px_per_arcmin * screen.text
                raise ProfileError(
                    f"{name}: screen_width_m {screen.screen_width_m:g} at eye_distance_m {screen.eye_distance_m:g} "
                    f"and {screen.width_px}x{screen.height_px} px draws '{item.text}' {have:.1f} arc minutes high; "
                    f"allowed: at least {item.arcmin * screen.text:g}"
                )
            box = bounds(item)
            outside = box.x < safe.x or box.y < safe.y or box.right > safe.right or box.bottom > safe.bottom
            if item.role != "ground" and outside:
                raise ProfileError(
                    f"{name}: width_px {screen.width_px}, height_px {screen.height_px}: {item.role} leaves the screen; "
                    "allowed: aspect ratio 4:3, 16:9 or three of these side by side"
                )


def sample_views(settings: HudSettings | None = None) -> list[HudView]:
    """Return a view of every mode, reason, take-over stage and of stale data, with the widest numbers."""
    wide = HudView(
        settings=settings or HudSettings(),
        shown_kmh=288,
        limit_kmh=130,
        rpm=6500.0,
        engine_running=True,
        gear="6",
        automatic=True,
        distance_m=123456.0,
    )
    wide = wide._replace(
        mode_label=wide.say(wide.mode_label),
        t_s=36000.0,
        link_age_s=0.9,
        remote_lateral=1.0,
        throttle=1.0,
        brake=1.0,
        clutch=1.0,
    )
    views = [wide._replace(mode=float(mode), mode_label=wide.say(mode_label(mode))) for mode in Mode]
    for reason in Reason:
        text = wide.say(reason_label(reason))
        views.append(wide._replace(reason_label=text, refusal_label=text))
    for mode in (Mode.STOPPED, Mode.EMERGENCY_STOP, Mode.MINIMAL_RISK):
        told = wide._replace(
            mode=float(mode),
            mode_label=wide.say(mode_label(mode)),
            reason_label=wide.say(reason_label(Reason.NO_REACTION)),
        )
        presses = [wide.say(phrase, button=LONGEST_BUTTON) for phrase in (PRESS_TO_DRIVE, PRESS_TO_RESET)]
        steps = [wide.say(phrase) for phrase in (*MENDING, STEER_OR_BRAKE, WAIT, ASK)]
        views += [told._replace(todo_label=label) for label in (*steps, *presses)]
    views += [wide._replace(other_side=side, driver_hand_wheel_deg=-900.0) for side in (AUTOPILOT, CONSOLE, NOBODY)]
    views += [wide._replace(notice_label=wide.say(notice_label(notice))) for notice in Notice]
    views += [wide._replace(notice_label=wide.say(phrase, **WIDEST)) for phrase in (BAND, ONE_SPEED, PREPARE)]
    asked = wide._replace(mode=float(Mode.TAKEOVER_REQUESTED), mode_label=wide.say(mode_label(Mode.TAKEOVER_REQUESTED)))
    views += [asked._replace(takeover_stage=stage, remaining_s=10.0) for stage in (1, 2)]
    validities = (0.0, 1.0, 2.0, 3.0, 4.0)
    views += [wide._replace(wheel_validity=v, pedals_validity=v, shifter_validity=v) for v in validities]
    views += [view._replace(recording_failed=True) for view in views]
    views.append(wide._replace(can_up=False, link="64 clients", force="limit"))
    views += [wide._replace(can_up=True, link=link) for link in (LINK_NOBODY, LINK_COMMANDER, LINK_CONNECTING)]
    views += [wide._replace(force=force, can_up=up) for force, up in (("limit", False), ("lost", True), ("on", None))]
    views += [wide._replace(turn_indicators=1.0), wide._replace(turn_indicators=-1.0), wide._replace(hazard_lights=1.0)]
    views += [wide._replace(lever_label=wide.say(text)) for text in (TWO_GEARS, NOT_NOW)]
    views += [wide._replace(link_age_s=None, handbrake=1.0, engine_running=False, hand_wheel_deg=-540.0)]
    turns = (Ahead(950.0, -1.6), Ahead(0.0, 3.1), Ahead(88.0, 1.6, 4), Ahead(12345.0, is_end=True))
    views += [wide._replace(ahead=turn) for turn in turns]
    return [*views, wide._replace(stale=True, ahead=turns[0])]
