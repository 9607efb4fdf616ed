"""What the driver and the operators see: the screen in the seat, and the operators' recording."""

from typing import Annotated

from msgspec import Meta, Struct


class HudProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The driver's instrument cluster and the screen it stands on.

    Width and distance decide how large a character must be drawn to be read: 20 minutes of arc for driving text.
    """

    width_px: Annotated[int, Meta(ge=320, le=16384)] = 1400
    height_px: Annotated[int, Meta(ge=240, le=8192)] = 1050
    screen_width_m: Annotated[float, Meta(gt=0.0, le=20.0)] = 1.6
    eye_distance_m: Annotated[float, Meta(gt=0.0, le=20.0)] = 2.2
    fullscreen: bool = False
    rate_hz: Annotated[int, Meta(ge=1, le=240)] = 60
    rpm_max: Annotated[float, Meta(ge=1000.0, le=20000.0)] = 7000.0
    rpm_red: Annotated[float, Meta(ge=500.0, le=20000.0)] = 6000.0


class SceneProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The operators' recording in rerun."""

    rate_hz: Annotated[int, Meta(ge=1, le=250)] = 50
    chunk_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 1.0
    flush_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 5.0
    chase_back_m: Annotated[float, Meta(gt=0.0, le=200.0)] = 11.0
    chase_up_m: Annotated[float, Meta(gt=0.0, le=200.0)] = 5.0
