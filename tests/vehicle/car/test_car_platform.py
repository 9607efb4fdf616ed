"""From a car's profile to its parameters."""

import pytest

from simconsole.values.platform import MOST_PATCHES, Ground, Patch
from tests.vehicle.driving import platform


def test_more_patches_than_there_is_room_for_are_refused() -> None:
    with pytest.raises(ValueError, match="at most 4"):
        platform(ground=Ground(1.0, 0.0, 0.0, patches=(Patch(0.0, 1.0, 0.0, 1.0, 0.5),) * (MOST_PATCHES + 1)))
