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
    """Version of this kind of file; always 1."""
    title: Annotated[str, Meta(min_length=1, max_length=40)]
    """Name of the language for people."""
    decimal_mark: Literal[".", ","] = "."
    """What stands between whole and fraction of a number on the display."""
    words: dict[Words, Words] = {}
    """Words of the display by the English of `profiles/languages/german.yaml`; what stands in braces is filled in by
    the display."""


ENGLISH: Final = LanguageProfile(schema=1, title="English")
"""The display's own words."""

Share = Annotated[float, Meta(ge=0.0, le=1.0)]


class ViewScreen(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One screen or beamer: where it stands in the window, and what of the scene it shows.

    The place is in shares of the road's part of its display's picture, from its lower left corner. On a display beside
    the one with the instruments the road ends at the same height.
    """

    display: Annotated[int, Meta(ge=0, le=15)] | None = None
    """Number of the display that the screen stands on; left out, the one with the instruments. The window spans all
    that are named."""
    yaw_deg: Annotated[float, Meta(ge=-180.0, le=180.0)] = 0.0
    """Where the screen's middle is from straight ahead, left-positive."""
    horizontal_fov_deg: Annotated[float, Meta(ge=10.0, le=150.0)] = 62.0
    """Angle of the scene that the screen shows from side to side."""
    left: Share = 0.0
    """Left edge of the screen in its display's picture of the road, as a share of the width."""
    bottom: Share = 0.0
    """Lower edge of the screen in its display's picture of the road, as a share of the height."""
    width: Annotated[float, Meta(gt=0.0, le=1.0)] = 1.0
    """Width of the screen, as a share of the picture's."""
    height: Annotated[float, Meta(gt=0.0, le=1.0)] = 1.0
    """Height of the screen, as a share of the picture's."""


class ModelFile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A model of the lab's own: binary glTF beside the session, in m, whose y points up.

    Its x axis is that of where it stands, its -z axis the y axis there.
    """

    file: Annotated[str, worded(r"^.{1,1000}\.glb$", "a file that ends in .glb")]
    """Name of the binary glTF file, in the folder of the session or below."""
    x_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    """Place of the model along x of where it stands."""
    y_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    """Place of the model along y of where it stands."""
    z_m: Annotated[float, Meta(ge=-1e3, le=1e4)] = 0.0
    """Height of the model above where it stands."""
    yaw_deg: Annotated[float, Meta(ge=-360.0, le=360.0)] = 0.0
    """Heading of the model, left-positive."""
    scale: Annotated[float, Meta(ge=1e-4, le=1e4)] = 1.0
    """Factor on the model's size."""


class DriverViewProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The road ahead in 3D above the instruments."""

    camera: Literal["driver", "chase", "bird"] = "driver"
    """Where the road is seen from: the driver's eyes, behind the car, or from above."""
    night: bool = False
    """Draw the scene by night, with headlights."""
    mirrors: bool = True
    """Draw the mirrors, where a graphics card draws."""
    shadows: bool = True
    """Draw shadows, where a graphics card draws."""
    samples: Annotated[int, Meta(ge=0, le=16)] = 4
    """Samples of a pixel that smooth edges. A processor that draws takes none, and neither mirrors nor shadows."""
    always_rich: bool = False
    """Draw mirrors, shadows and smooth edges also where the processor draws."""
    horizon: Annotated[float, Meta(ge=0.1, le=0.9)] = 0.55
    """Height of the level horizon in the picture, as a share of its height."""
    vehicle_model: ModelFile | None = None
    """Model of the driven vehicle from outside, placed from base_link, without what turns: wheels are drawn as without
    it."""
    models: Annotated[tuple[ModelFile, ...], Meta(max_length=200)] = ()
    """Models of what else stands in the world, placed in the map's frame."""
    screens: Annotated[tuple[ViewScreen, ...], Meta(min_length=1, max_length=8)] = (ViewScreen(),)
    """Screens or beamers that the road is shown on; left out, one that fills the picture."""


class HudProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The driver's instrument cluster and the screen it stands on.

    Width and distance decide how large a character must be drawn to be read: 20 minutes of arc for driving text.
    """

    width_px: Annotated[int, Meta(ge=320, le=16384)] = 1400
    """Width of the window."""
    height_px: Annotated[int, Meta(ge=240, le=8192)] = 1050
    """Height of the window."""
    screen_width_m: Annotated[float, Meta(gt=0.0, le=20.0)] = 1.6
    """Width of the screen in front of the driver; with `eye_distance_m` it says how large text must be."""
    eye_distance_m: Annotated[float, Meta(gt=0.0, le=20.0)] = 2.2
    """Distance from the driver's eyes to the screen."""
    display: Annotated[int, Meta(ge=0, le=15)] = 0
    """Number of the display that the window opens on. This, `fullscreen` and `vsync` can be changed by key, which is
    remembered."""
    fullscreen: bool = False
    """Whether the window fills its display."""
    vsync: bool = True
    """Show the road in step with the display; the instruments alone never are."""
    rate_hz: Annotated[int, Meta(ge=1, le=240)] = 60
    """How many pictures are drawn in a second, at most."""
    language: ProfileName = "english"
    """Language of the display alone: topics, metrics, reports and logs keep their words."""
    large_text: bool = False
    """Draw all text a quarter larger; the instruments without the road leave the pedals out for it."""
    rpm_max: Annotated[float, Meta(ge=1000.0, le=20000.0)] = 7000.0
    """Engine speed at the end of the dial."""
    rpm_red: Annotated[float, Meta(ge=500.0, le=20000.0)] = 6000.0
    """Engine speed from which the dial is red."""
    view: DriverViewProfile | None = None
    """The road above the instruments; left out, the instruments have the whole screen."""


Gain = Annotated[float, Meta(ge=0.0, le=2.0)]


class SoundProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What the driver hears. Shares of full loudness; warnings do not hang on `volume` and cannot be silenced."""

    device: Annotated[str, Meta(max_length=200)] | None = None
    """A loudspeaker device by its name, as `simconsole devices speakers` says; left out, the system's."""
    speakers: Literal[2, 6] = 6
    """Number of loudspeakers, six as in 5.1; where the device has two only, the other four are folded in."""
    volume: Share = 0.8
    """Loudness of all but warnings, as a share of the full one."""
    warnings: Annotated[float, Meta(ge=0.2, le=1.0)] = 0.9
    """Loudness of warnings, as a share of the full one; they cannot be silenced."""
    engine: Gain = 1.0
    """Loudness of the engine, as a factor."""
    road: Gain = 1.0
    """Loudness of tyres and wind, as a factor."""
    others: Gain = 1.0
    """Loudness of other road users, as a factor."""
    gains: tuple[Gain, Gain, Gain, Gain, Gain, Gain] = (1.0,) * 6
    """Factor of each loudspeaker: front left, front right, centre, low frequencies, surround left, surround right."""


class SceneProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The operators' recording in rerun."""

    rate_hz: Annotated[int, Meta(ge=1, le=250)] = 50
    """How many states of a second are recorded."""
    chunk_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 0.25
    """How often what has been gathered is written into the recording."""
    flush_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 5.0
    """How long the end of the drive waits for the recording to be written whole."""
    chase_back_m: Annotated[float, Meta(gt=0.0, le=200.0)] = 11.0
    """How far behind the car the viewer's camera is."""
    chase_up_m: Annotated[float, Meta(gt=0.0, le=200.0)] = 5.0
    """How far above the car the viewer's camera is."""
