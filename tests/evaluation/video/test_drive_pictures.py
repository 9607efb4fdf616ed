"""Pictures of a recorded drive, from a real context without a window."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.video.drive_pictures import CameraName, DrivePictures, Pixels, Wanted
from simconsole.evaluation.video.moments import VideoFrame, moments
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError
from simconsole.values.kernels import put
from simconsole.values.signals import Mode, Reason
from simconsole.values.state_vector import LAYOUT

SIZE = (640, 480)
CAMERAS: tuple[CameraName, ...] = ("chase", "bird")
"""Those beside the driver's."""


@pytest.fixture(scope="module")
def resolved(short: Path) -> ResolvedSession:
    return recorded_session(open_bundle(short))


@pytest.fixture(scope="module")
def found(short: Path) -> list[VideoFrame]:
    return list(moments(open_bundle(short).log, 1.0, 2.9, 2))


def pictures(resolved: ResolvedSession, found: list[VideoFrame], camera: CameraName = "driver") -> list[Pixels]:
    return list(DrivePictures(resolved, Wanted(*SIZE, camera)).draw_all(iter(found)))


@pytest.fixture(scope="module")
def driver(resolved: ResolvedSession) -> DrivePictures:
    """The driver's camera, which has seen nothing yet."""
    return DrivePictures(resolved, Wanted(*SIZE))


@pytest.fixture(scope="module")
def seen(driver: DrivePictures, found: list[VideoFrame]) -> list[Pixels]:
    """What the driver's camera saw."""
    return list(driver.draw_all(iter(found)))


def test_the_same_moments_give_the_same_pictures(
    resolved: ResolvedSession, found: list[VideoFrame], seen: list[Pixels]
) -> None:
    first, again = seen, pictures(resolved, found)
    assert all((one == other).all() for one, other in zip(first, again, strict=True))
    assert first[0].shape == (480, 640, 3)
    assert (first[0] != first[-1]).any(), "the car has driven off"


def test_the_sky_is_above_and_the_instruments_below(seen: list[Pixels]) -> None:
    picture = seen[0].astype(int)
    sky, strip = picture[40:60].mean(axis=(0, 1)), picture[-60:].mean(axis=(0, 1))
    assert sky[2] > sky[0]
    assert np.mean(strip) < 0.6 * np.mean(sky)


def test_each_camera_sees_something_else(
    resolved: ResolvedSession, found: list[VideoFrame], seen: list[Pixels]
) -> None:
    chase, bird = (pictures(resolved, found[:1], camera)[0] for camera in CAMERAS)
    road = slice(0, 240)
    assert (seen[0][road] != chase[road]).any()
    assert (chase[road] != bird[road]).any()


@pytest.mark.usefixtures("seen")
def test_the_instruments_remember_what_is_passed_over(driver: DrivePictures, found: list[VideoFrame]) -> None:
    """Why the car was stopped: STOPPED itself only says that it stands."""

    def in_mode(moment: VideoFrame, mode: Mode, reason: Reason) -> VideoFrame:
        vector = moment.snapshot.vector.copy()
        arbitration = moment.snapshot.arbitration._replace(mode=float(mode), reason=float(reason))
        put(vector, LAYOUT.arbitration.start, arbitration)
        return moment._replace(snapshot=moment.snapshot._replace(vector=vector))

    stopping = in_mode(found[0], Mode.MINIMAL_RISK, Reason.DEVICE_LOST)
    stands = in_mode(found[0], Mode.STOPPED, Reason.STANDSTILL)
    untold = driver.draw(stands)
    assert (driver.draw(stands) == untold).all()
    driver.pass_over(iter([stopping]))
    assert (driver.draw(stands) != untold).any()


def test_a_size_that_cannot_be_read_is_refused(resolved: ResolvedSession) -> None:
    with pytest.raises(ProfileError, match="--size: "):
        DrivePictures(resolved, Wanted(1400, 320))
