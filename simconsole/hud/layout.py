"""The driver's instrument cluster: `layout` turns a view into a draw list. Pure; no graphics library.

Top to bottom inside the safe area: who drives (mode as label and shape), one slot for the one alert, then pedals,
dial and steering side by side, then a strip of lamps. Each thing has one place at all times.
"""

import math
from typing import Final, NamedTuple

from simconsole.hud.banner import Alert, alert_of, banner, slot
from simconsole.hud.dial import dial
from simconsole.hud.draw import BACKGROUND, Box, DrawItem, Rect, Text, bounds
from simconsole.hud.panels import pedals, status, steering
from simconsole.hud.screen import Screen
from simconsole.hud.strip import HEIGHT_ARCMIN, strip
from simconsole.hud.view import HudView
from simconsole.hud.words import AUTOPILOT, CONSOLE, LONGEST_PRESS, MENDING, NOBODY
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
BANNER_ARCMIN: Final = 168.0
SLOT_ARCMIN: Final = 130.0
"""Heights under the road at which each text has the size that it needs (`check_screen`)."""


class Places(NamedTuple):
    """Where each part of the cluster stands."""

    banner: Box
    slot: Box
    left: Box
    dial: Box
    right: Box
    status: Box


class PlacesUnderView(NamedTuple):
    """Where the instruments stand that leave the road most of the screen."""

    slot: Box  # at the top, only while there is something to say
    strip: Box
    banner: Box


def places(screen: Screen) -> Places:
    """Divide the driver's screen."""
    area = screen.content()
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


def places_under_view(screen: Screen) -> PlacesUnderView:
    """Divide the driver's screen by what must be legible: heights are angles at the driver's eye, not shares."""
    area, unit = screen.content(), screen.px_per_arcmin
    gap = GAP * area.h
    banner = Box(area.x, area.bottom - BANNER_ARCMIN * unit, area.w, BANNER_ARCMIN * unit)
    height = HEIGHT_ARCMIN * unit
    return PlacesUnderView(
        slot=Box(area.x, area.y, area.w, SLOT_ARCMIN * unit),
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
        return [ground, *strip(view, under.strip), *message, *banner(view, alert, under.banner)]
    place = places(screen)
    return [
        ground,
        *pedals(view, place.left),
        *dial(view, place.dial),
        *steering(view, place.right),
        *status(view, place.status),
        *slot(view, alert, place.slot, screen),
        *banner(view, alert, place.banner),
    ]


def panels_over_view(view: HudView, screen: Screen) -> tuple[Box, ...]:
    """Return the parts of the screen that hide the road: a message if there is one, and, last, the instruments."""
    place, pad = places_under_view(screen), 0.5 * GAP * screen.height_px
    top = float(math.floor(place.strip.y - pad))
    instruments = Box(0.0, top, screen.width_px, screen.height_px - top)
    if alert_of(view) is Alert.NONE:
        return (instruments,)
    safe = screen.safe()  # a take-over spans every screen
    return (Box(safe.x, place.slot.y, safe.w, place.slot.h).inset(-pad), instruments)


def check_screen(screen: Screen, name: str) -> None:
    """Fail at start-up when some text would be too small to read, or something would leave the safe area.

    Args:
        screen: the screen to check.
        name: what to call its profile in the message.

    Raises:
        ProfileError: names the keys to change.
    """
    safe = screen.safe()
    for view in sample_views():
        for item in layout(view, screen):
            if isinstance(item, Text) and item.cap_px < item.arcmin * screen.px_per_arcmin:
                have = item.cap_px / screen.px_per_arcmin
                raise ProfileError(
                    f"{name}: screen_width_m {screen.screen_width_m:g} at eye_distance_m {screen.eye_distance_m:g} "
                    f"and {screen.width_px}x{screen.height_px} px draws '{item.text}' {have:.1f} arc minutes high; "
                    f"allowed: at least {item.arcmin:g}"
                )
            box = bounds(item)
            outside = box.x < safe.x or box.y < safe.y or box.right > safe.right or box.bottom > safe.bottom
            if item.role != "ground" and outside:
                raise ProfileError(
                    f"{name}: width_px {screen.width_px}, height_px {screen.height_px}: {item.role} leaves the screen; "
                    "allowed: aspect ratio 4:3, 16:9 or three of these side by side"
                )


def sample_views() -> list[HudView]:
    """Return a view of every mode, reason, take-over stage and of stale data, with the widest numbers."""
    wide = HudView(
        shown_kmh=288, limit_kmh=130, rpm=6500.0, engine_running=True, gear="6", automatic=True, distance_m=123456.0
    )
    wide = wide._replace(t_s=36000.0, link_age_s=0.9, remote_lateral=1.0, throttle=1.0, brake=1.0, clutch=1.0)
    views = [wide._replace(mode=float(mode), mode_label=mode_label(mode)) for mode in Mode]
    for reason in Reason:
        text = reason_label(reason)
        views.append(wide._replace(reason_label=text, refusal_label=text))
    for mode in (Mode.STOPPED, Mode.EMERGENCY_STOP, Mode.MINIMAL_RISK):
        told = wide._replace(
            mode=float(mode), mode_label=mode_label(mode), reason_label=reason_label(Reason.NO_REACTION)
        )
        views += [told._replace(todo_label=label) for label in (*MENDING, LONGEST_PRESS)]
    views += [wide._replace(other_side=side, driver_hand_wheel_deg=-900.0) for side in (AUTOPILOT, CONSOLE, NOBODY)]
    views += [wide._replace(notice_label=notice_label(notice)) for notice in Notice]
    asked = wide._replace(mode=float(Mode.TAKEOVER_REQUESTED), mode_label=mode_label(Mode.TAKEOVER_REQUESTED))
    views += [asked._replace(takeover_stage=stage, remaining_s=10.0) for stage in (1, 2)]
    validities = (0.0, 1.0, 2.0, 3.0, 4.0)
    views += [wide._replace(wheel_validity=v, pedals_validity=v, shifter_validity=v) for v in validities]
    views += [view._replace(recording_failed=True) for view in views]
    views.append(wide._replace(can_up=False, link="64 clients", force="limit"))
    views += [wide._replace(can_up=True, link=link) for link in (LINK_NOBODY, LINK_COMMANDER, LINK_CONNECTING)]
    views += [wide._replace(force=force, can_up=up) for force, up in (("limit", False), ("lost", True), ("on", None))]
    views += [wide._replace(turn_indicators=1.0), wide._replace(turn_indicators=-1.0), wide._replace(hazard_lights=1.0)]
    views += [wide._replace(lever_label=text) for text in ("two gears", "not now")]
    views += [wide._replace(link_age_s=None, handbrake=1.0, engine_running=False, hand_wheel_deg=-540.0)]
    return [*views, wide._replace(stale=True)]
