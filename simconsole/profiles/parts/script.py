"""The script of a drive: what a person does, from instant to instant."""

from typing import Annotated, Literal, TypeAlias

from msgspec import Meta, Struct

from simconsole.profiles.parts.ranges import Share, Title

ButtonName: TypeAlias = Literal[
    "autonomous",
    "manual",
    "emergency_stop",
    "reset",
    "shift_up",
    "shift_down",
    "indicator_left",
    "indicator_right",
    "mark",
    "pause",
    "restart",
    "takeover",
    "shared",
    "fault",
    "hazard",
    "handbrake_button",
    "horn",
]


class ScriptPoint(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What the person does at one instant. A key left out is interpolated to its next mention."""

    time_s: Annotated[float, Meta(ge=0.0, le=86_400.0)]
    """When, from the start of the drive; later than the point before."""
    throttle: Share | None = None
    """Share of the throttle pedal, 0 to 1; left out, it goes in a straight line to its next mention."""
    brake: Share | None = None
    """Share of the brake pedal, 0 to 1; left out, it goes in a straight line to its next mention."""
    clutch: Share | None = None
    """Share of the clutch pedal, 0 to 1, 1 is pressed; left out, it goes in a straight line to its next mention."""
    handbrake: Share | None = None
    """Share of the handbrake, 0 to 1; left out, it goes in a straight line to its next mention."""
    hand_wheel_deg: Annotated[float, Meta(ge=-1260.0, le=1260.0)] | None = None
    """Angle of the hand wheel, left is positive; left out, it goes in a straight line to its next mention."""
    gear: Annotated[int, Meta(ge=-1, le=7)] | None = None
    """Gear of the lever: -1 reverse, 0 neutral; left out, it stays as it is."""
    press: list[ButtonName] = []
    """Buttons that are pressed at this time, each held for 0.2 s."""


class ScriptProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A person as a script: pedals and wheel go in straight lines from mention to mention, the lever in steps."""

    schema: Literal[1] = 1
    """Version of this kind of file; always 1."""
    title: Title = ""
    """Name of the script for people."""
    points: Annotated[list[ScriptPoint], Meta(min_length=1, max_length=100_000)]
    """What the person does, from instant to instant."""

    def __post_init__(self) -> None:
        """Refuse points whose time does not grow.

        Raises:
            ValueError: names the first such point.
        """
        for index in range(1, len(self.points)):
            earlier, later = self.points[index - 1].time_s, self.points[index].time_s
            if later <= earlier:
                raise ValueError(f"points[{index}].time_s {later} must be above {earlier}, time only goes forward")
