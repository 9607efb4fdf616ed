import pytest

from simconsole.profiles.world import MapFile, RandomRoute, RoadsProfile, RouteByEdges, RouteByPlaces
from simconsole.values.errors import ProfileError
from simconsole.world.roads.road_world import planned, road_world
from tests.world.nets import TOWN, generated_map, straight_map


def profile(route: RouteByEdges | RouteByPlaces | RandomRoute) -> RoadsProfile:
    return RoadsProfile(schema=1, title="test", map=MapFile(name="f.net.xml"), route=route)


@pytest.mark.parametrize(
    "route",
    [RouteByEdges(edges=("AB", "BC")), RouteByPlaces(start="AB", goal="BC"), RandomRoute(seed=0, length_m=150.0)],
)
def test_each_way_to_say_a_route(route: RouteByEdges | RouteByPlaces | RandomRoute) -> None:
    world = road_world(profile(route), straight_map())
    assert world.route.length_m == pytest.approx(200.0, abs=0.1)
    assert len(world.drawing.path) > 100
    assert world.title == "test"


@pytest.mark.parametrize(
    ("route", "told"),
    [
        (RouteByEdges(edges=("AB", "nowhere")), r"f.net.xml: route.edges\[1\]: value 'nowhere': an edge of the map"),
        (RouteByEdges(edges=("BC", "AB")), "f.net.xml: route.edges: no way for a car leads there"),
        (RouteByPlaces(start="BC", goal="AB"), "f.net.xml: route.goal: no way for a car leads there"),
        (RouteByPlaces(start="?", goal="AB"), r"f.net.xml: route.start: value '\?': an edge of the map"),
    ],
)
def test_route_that_nobody_can_drive_is_refused(route: RouteByEdges | RouteByPlaces, told: str) -> None:
    with pytest.raises(ProfileError, match=told):
        planned(profile(route), straight_map())


@pytest.mark.parametrize("seed", range(4))
def test_turns_too_tight_for_a_car_are_driven_round(seed: int) -> None:
    route = planned(profile(RandomRoute(seed=seed, length_m=700.0)), generated_map(*TOWN)).route
    assert float(abs(route.curvature).max()) <= 0.21
    assert route.length_m >= 650.0
