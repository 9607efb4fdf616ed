"""What the driver and the operators see: the screen in the seat, and the operators' recording."""

from typing import Annotated, Final, Literal

from msgspec import Meta, Struct

from simconsole.profiles.validation import ProfileName, worded

Words = Annotated[
    str,
    worded(
        r"^[ -~\u00a0-\u00ff]+$",
        "1 to 60 characters of Western European languages (Latin-1)",
        min_length=1,
        max_length=60,
    ),
]
"""What the display's typeface can draw: the characters of Western European languages (Latin-1)."""


class LanguageProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What the display says in place of its own English. What is not named stays English.

    Only the display speaks it: topics, metrics, reports and logs keep their words.
    """

    schema: Literal[1]
    title: Annotated[str, Meta(min_length=1, max_length=40)]
    decimal_mark: Literal[".", ","] = "."
    words: dict[Words, Words] = {}
    """By the English of `profiles/languages/german.yaml`; what stands in braces is filled in by the display."""


ENGLISH: Final = LanguageProfile(schema=1, title="English")
"""The display's own words."""

Share = Annotated[float, Meta(ge=0.0, le=1.0)]


class ViewScreen(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One screen or beamer: where it stands in the window, and what of the scene it shows.

    The place is in shares of the road's part of its display's picture, from its lower left corner. On a display beside
    the one with the instruments the road ends at the same height.
    """

    display: Annotated[int, Meta(ge=0, le=15)] | None = None
    """On which display it stands; None: on the one with the instruments. The window spans all that are named."""
    yaw_deg: Annotated[float, Meta(ge=-180.0, le=180.0)] = 0.0
    """Where the screen's middle is from straight ahead, left-positive."""
    horizontal_fov_deg: Annotated[float, Meta(ge=10.0, le=150.0)] = 62.0
    """Angle of the scene that the screen shows from side to side."""
    left: Share = 0.0
    bottom: Share = 0.0
    width: Annotated[float, Meta(gt=0.0, le=1.0)] = 1.0
    height: Annotated[float, Meta(gt=0.0, le=1.0)] = 1.0


class ModelFile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A model of the lab's own: binary glTF beside the session, in m, whose y points up.

    Its x axis is that of where it stands, its -z axis the y axis there.
    """

    file: Annotated[str, worded(r"^.{1,1000}\.glb$", "a file that ends in .glb")]
    x_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    y_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    z_m: Annotated[float, Meta(ge=-1e3, le=1e4)] = 0.0
    yaw_deg: Annotated[float, Meta(ge=-360.0, le=360.0)] = 0.0
    scale: Annotated[float, Meta(ge=1e-4, le=1e4)] = 1.0


class DriverViewProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The road ahead in 3D above the instruments."""

    camera: Literal["driver", "chase", "bird"] = "driver"
    night: bool = False
    mirrors: bool = True
    shadows: bool = True
    samples: Annotated[int, Meta(ge=0, le=16)] = 4
    """Samples of a pixel that smooth edges. A processor that draws takes none, and neither mirrors nor shadows."""
    always_rich: bool = False
    """Draw mirrors, shadows and smooth edges also where the processor draws."""
    horizon: Annotated[float, Meta(ge=0.1, le=0.9)] = 0.55
    """Height of the level horizon in the picture."""
    vehicle_model: ModelFile | None = None
    """The driven vehicle from outside, placed from base_link, without what turns: wheels are drawn as without it."""
    models: Annotated[tuple[ModelFile, ...], Meta(max_length=200)] = ()
    """What else stands in the world, placed in map."""
    screens: Annotated[tuple[ViewScreen, ...], Meta(min_length=1, max_length=8)] = (ViewScreen(),)


class HudProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The driver's instrument cluster and the screen it stands on.

    Width and distance decide how large a character must be drawn to be read: 20 minutes of arc for driving text.
    """

    width_px: Annotated[int, Meta(ge=320, le=16384)] = 1400
    height_px: Annotated[int, Meta(ge=240, le=8192)] = 1050
    screen_width_m: Annotated[float, Meta(gt=0.0, le=20.0)] = 1.6
    eye_distance_m: Annotated[float, Meta(gt=0.0, le=20.0)] = 2.2
    display: Annotated[int, Meta(ge=0, le=15)] = 0
    """Which display the window opens on. This, `fullscreen` and `vsync` can be changed by key, which is remembered."""
    fullscreen: bool = False
    vsync: bool = True
    """The road is shown in step with the display; the instruments alone never are."""
    rate_hz: Annotated[int, Meta(ge=1, le=240)] = 60
    language: ProfileName = "english"
    """Of the display alone: topics, metrics, reports and logs keep their words."""
    large_text: bool = False
    """All text a quarter larger; the instruments without the road leave the pedals out for it."""
    rpm_max: Annotated[float, Meta(ge=1000.0, le=20000.0)] = 7000.0
    rpm_red: Annotated[float, Meta(ge=500.0, le=20000.0)] = 6000.0
    view: DriverViewProfile | None = None
    """The road above the instruments; without it the instruments have the whole screen."""


Gain = Annotated[float, Meta(ge=0.0, le=2.0)]


class SoundProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What the driver hears. Shares of full loudness; warnings do not hang on `volume` and cannot be silenced."""

    device: Annotated[str, Meta(max_length=200)] | None = None
    """A device by its name (`simconsole devices speakers`), None: the system's."""
    speakers: Literal[2, 6] = 6
    """Six as in 5.1; where the device has two only, the other four are folded in."""
    volume: Share = 0.8
    warnings: Annotated[float, Meta(ge=0.2, le=1.0)] = 0.9
    engine: Gain = 1.0
    road: Gain = 1.0
    others: Gain = 1.0
    gains: tuple[Gain, Gain, Gain, Gain, Gain, Gain] = (1.0,) * 6
    """Of each loudspeaker: front left, front right, centre, low frequencies, surround left, surround right."""


class SceneProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The operators' recording in rerun."""

    rate_hz: Annotated[int, Meta(ge=1, le=250)] = 50
    chunk_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 0.25
    flush_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 5.0
    chase_back_m: Annotated[float, Meta(gt=0.0, le=200.0)] = 11.0
    chase_up_m: Annotated[float, Meta(gt=0.0, le=200.0)] = 5.0
