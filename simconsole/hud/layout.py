"""The driver's instrument cluster: `layout` turns a view into a draw list. Pure; no graphics library.

Top to bottom inside the safe area: who drives (mode as label and shape), one slot for the one alert, then pedals,
dial and steering side by side, then a strip of lamps. Each thing has one place at all times.
"""

import math
from typing import Final, NamedTuple

from simconsole.hud.banner import alert_of, banner, slot
from simconsole.hud.dial import dial
from simconsole.hud.draw import BACKGROUND, Box, DrawItem, Rect, Text, bounds
from simconsole.hud.panels import pedals, status, steering
from simconsole.hud.screen import Screen
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


class Places(NamedTuple):
    """Where each part of the cluster stands."""

    banner: Box
    slot: Box
    left: Box
    dial: Box
    right: Box
    status: Box


class _Rows(NamedTuple):
    """From top to bottom, in shares of the safe area's height."""

    banner: tuple[float, float]
    slot: tuple[float, float]
    middle: tuple[float, float]
    status: tuple[float, float]


class _Heights(NamedTuple):
    """The same parts by height, in minutes of arc."""

    banner: float
    slot: float
    middle: float
    status: float


_ALONE: Final = _Rows(banner=(0.0, 0.135), slot=(0.15, 0.26), middle=(0.275, 0.88), status=(0.90, 1.0))
_LEAST_ARCMIN: Final = _Heights(banner=168.0, slot=130.0, middle=636.0, status=130.0)
"""Heights at which every text of a part has the size that it needs (`check_screen`): the road has the rest."""


def _rows_under_view(area: Box, px_per_arcmin: float) -> _Rows:
    """Return the rows that leave the road as much of the screen as legible instruments allow."""
    banner, slot, middle, status = (arcmin * px_per_arcmin / area.h for arcmin in _LEAST_ARCMIN)
    gap = 0.5 * GAP
    return _Rows(
        banner=(0.0, banner),
        slot=(banner + gap, banner + gap + slot),
        middle=(1.0 - status - gap - middle, 1.0 - status - gap),
        status=(1.0 - status, 1.0),
    )


def places(screen: Screen) -> Places:
    """Divide the driver's screen."""
    area = screen.content()
    rows = _rows_under_view(area, screen.px_per_arcmin) if screen.has_view else _ALONE
    middle = area.row(*rows.middle)
    dial_width = min(1.125 * middle.h, 0.50 * area.w)
    gap = GAP * area.h
    side = 0.5 * (area.w - dial_width) - gap
    left = Box(area.cx - 0.5 * dial_width - gap - side, middle.y, side, middle.h)
    right = Box(area.cx + 0.5 * dial_width + gap, middle.y, side, middle.h)
    return Places(
        banner=area.row(*rows.banner),
        slot=area.row(*rows.slot),
        left=left,
        dial=Box(area.cx - 0.5 * dial_width, middle.y, dial_width, middle.h),
        right=right,
        status=area.row(*rows.status),
    )


def layout(view: HudView, screen: Screen) -> list[DrawItem]:
    """Return everything to draw, back to front, in pixels of `screen`."""
    place = places(screen)
    alert = alert_of(view)
    ground = Rect(Box(0.0, 0.0, screen.width_px, screen.height_px), BACKGROUND, "ground")
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
    """Return the parts of the screen that hide the road: who drives, the one alert if there is one, the instruments."""
    place, pad = places(screen), math.ceil(GAP * screen.height_px)
    top = min(place.left.y, place.dial.y) - pad
    instruments = Box(0.0, top, screen.width_px, screen.height_px - top)
    shown = (place.banner, place.slot) if alert_of(view) is not None else (place.banner,)
    return (*(box.inset(-0.5 * pad) for box in shown), instruments)


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
    wide = HudView(shown_kmh=288, rpm=6500.0, engine_running=True, gear="6", automatic=True, distance_m=123456.0)
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
