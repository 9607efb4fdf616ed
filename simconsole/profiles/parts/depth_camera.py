"""A robot's camera that measures depths."""

import math
from typing import Annotated

import msgspec


class DepthCameraProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A camera that looks straight ahead and measures how far along its axis everything is."""

    width_px: Annotated[int, msgspec.Meta(ge=8, le=1920)]
    """Width of a picture."""
    height_px: Annotated[int, msgspec.Meta(ge=8, le=1080)]
    """Height of a picture."""
    horizontal_fov_deg: Annotated[float, msgspec.Meta(ge=10.0, le=150.0)]
    """Angle from the left to the right edge of a picture."""
    min_m: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)]
    """Nearest depth that is measured, along the axis."""
    max_m: Annotated[float, msgspec.Meta(ge=0.1, le=100.0)]
    """Farthest depth that is measured, along the axis; above `min_m`."""
    x_m: Annotated[float, msgspec.Meta(ge=-1.0, le=1.0)]
    """How far ahead of base_footprint the camera is."""
    z_m: Annotated[float, msgspec.Meta(ge=0.01, le=2.0)]
    """Height of the camera above the floor."""

    def __post_init__(self) -> None:
        """Refuse depths out of order.

        Raises:
            ValueError: names the key.
        """
        if not self.min_m < self.max_m:
            raise ValueError(f"min_m {self.min_m} must be below max_m {self.max_m}")

    @property
    def focal_px(self) -> float:
        """Focal length in pixels: that of a pinhole, without distortion."""
        return 0.5 * self.width_px / math.tan(0.5 * math.radians(self.horizontal_fov_deg))
