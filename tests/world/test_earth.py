"""Places on the earth, against PROJ."""

import numpy as np
import pyproj
import pytest

from simconsole.world.earth import ORIGIN_DEG, earth_of
from tests.samples import Sample

NEAR_M = 1e-3
METRES_PER_DEG = 111_320.0


@pytest.mark.parametrize(
    ("projection", "middle"),
    [
        ("+proj=utm +zone=33 +ellps=WGS84 +datum=WGS84 +units=m +no_defs", (600_000.0, 5_340_000.0)),
        ("+proj=utm +zone=1 +datum=WGS84 +units=m +no_defs", (300_000.0, 20_000.0)),
        ("+proj=utm +zone=60 +south +datum=WGS84 +units=m +no_defs +type=crs", (400_000.0, 5_900_000.0)),
        ("+proj=tmerc +lat_0=48.2 +lon_0=16.37 +k=1 +ellps=WGS84", (0.0, 0.0)),
        ("+proj=tmerc +lat_0=-33 +lon_0=151 +k_0=0.9999 +x_0=300000 +y_0=5000000 +ellps=GRS80", (3e5, 5e6)),
        ("+proj=tmerc +lat_0=78 +lon_0=-170 +ellps=GRS80", (0.0, 0.0)),
    ],
)
def test_places_are_those_of_proj(sample: Sample, projection: str, middle: tuple[float, float]) -> None:
    earth = earth_of(projection)
    assert earth is not None
    proj, worst = pyproj.Proj(projection), 0.0
    offsets = np.random.default_rng(sample.seed).uniform(-150e3, 150e3, (sample.of(200, 20_000), 2))
    for x, y in (offsets + middle).tolist():
        longitude, latitude = proj(x, y, inverse=True)
        found = earth.place(x, y)
        east = np.remainder(found.longitude_deg - longitude + 180.0, 360.0) - 180.0
        away = METRES_PER_DEG * np.hypot(found.latitude_deg - latitude, east * np.cos(np.radians(latitude)))
        worst = max(worst, float(away))
    print(f"measured: at most {worst * 1e6:.3f} um from PROJ")
    assert worst < NEAR_M


def test_offset_of_a_map_is_taken_off_before_the_projection() -> None:
    projection = "+proj=utm +zone=33 +ellps=WGS84 +datum=WGS84 +units=m +no_defs"
    moved = earth_of(projection, (-600_000.0, -5_340_000.0))
    whole = earth_of(projection)
    assert moved is not None
    assert whole is not None
    assert moved.place(12.0, -7.0) == pytest.approx(whole.place(600_012.0, 5_339_993.0), abs=1e-12)


def test_world_that_does_not_say_where_it_is_lies_round_the_origin() -> None:
    earth = earth_of("!", (5.0, 7.0))
    assert earth is not None
    assert earth.place(0.0, 0.0) == pytest.approx(ORIGIN_DEG, abs=1e-12)
    north = earth.place(0.0, 1000.0)
    assert north.latitude_deg - ORIGIN_DEG[0] == pytest.approx(1000.0 / 111_200.0, rel=1e-3)
    assert earth.place(1000.0, 0.0).longitude_deg > ORIGIN_DEG[1]


@pytest.mark.parametrize(
    "projection",
    [
        "+proj=lcc +lat_1=49 +lat_2=44 +lat_0=46.5 +lon_0=3 +ellps=GRS80",
        "+proj=utm +zone=61 +datum=WGS84",
        "+proj=utm +zone=x +datum=WGS84",
        "+proj=utm +datum=WGS84",
        "+proj=utm +zone=33 +ellps=bessel",
        "+proj=tmerc +lat_0=90",
        "+proj=tmerc +k=nan",
        "+proj=tmerc +units=us-ft",
        "+proj=tmerc +towgs84=1,2,3",
        "EPSG:31256",
    ],
)
def test_projection_that_is_not_known_is_no_place(projection: str) -> None:
    assert earth_of(projection) is None
