"""From a world's profile to the world, whatever its kind: the one place that knows them all."""

from collections.abc import Callable
from functools import lru_cache, partial

from simconsole.profiles.files.world_files import read_map
from simconsole.profiles.world import ArenaProfile, CourseProfile, OwnWorldProfile, RoadsProfile, WorldProfile
from simconsole.world.arena.arena_world import ArenaWorld
from simconsole.world.course import Course
from simconsole.world.course_relief import course_field
from simconsole.world.drawing import draw
from simconsole.world.earth import earth_of
from simconsole.world.registered import make_own
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.roads.road_world import road_world, roads_of
from simconsole.world.roads.running import RunningNow
from simconsole.world.rules.road_signals import RoadSignals
from simconsole.world.rules.running_signals import RunningSignals
from simconsole.world.world import ShownMap, World


@lru_cache(maxsize=4)
def open_world(profile: WorldProfile) -> World:
    """Return the world of a profile.

    Raises:
        ProfileError: a file of its map cannot be read, or no route leads over it as its profile says, or no
            package has registered such a world or it breaks the contract.
    """
    if isinstance(profile, CourseProfile):
        course = Course(profile)
        raise_ground = None if profile.ground is None else partial(course_field, course, profile.ground)
        return World(profile.title, course, partial(draw, course), raise_ground)
    if isinstance(profile, ArenaProfile):
        return ArenaWorld(profile)
    if isinstance(profile, OwnWorldProfile):
        return make_own(profile)
    return road_world(profile, open_map(profile))


def open_map(profile: RoadsProfile) -> RoadMap:
    """Return the road map of a world, with the polygons beside it.

    Raises:
        ProfileError: a file cannot be read as what it should be.
    """
    from simconsole.world.sumo.net_reader import read_net
    from simconsole.world.sumo.polygons import read_polygons

    found = read_net(read_map(profile.map), profile.map.name)
    if profile.polygons is None:
        return found
    things, skipped = read_polygons(read_map(profile.polygons), profile.polygons.name)
    report = found.report._replace(skipped=found.report.skipped + skipped)
    moved = tuple(thing._replace(outline=thing.outline - found.moved_m) for thing in things)
    return found._replace(obstacles=moved, report=report)


def road_signals(profile: WorldProfile | None, tick_hz: int) -> RoadSignals | None:
    """Return the traffic lights of a world; None where it has no road map. Raises as open_world."""
    if not isinstance(profile, RoadsProfile):
        return None
    roads = roads_of(open_world(profile))
    return None if roads is None else RoadSignals(roads.road_map, tick_hz)


def running_signals(
    profile: WorldProfile | None, tick_hz: int, newest: Callable[[], RunningNow] | None = None
) -> RunningSignals | None:
    """Return the traffic lights of a world that another simulator runs (`newest`, or as they are taken).

    None where it has no road map. Raises as open_world.
    """
    if not isinstance(profile, RoadsProfile):
        return None
    roads = roads_of(open_world(profile))
    return None if roads is None else RunningSignals(roads.road_map, tick_hz, newest)


def shown_map(profile: WorldProfile | None) -> ShownMap:
    """Return what those outside are told of a world. Raises as open_world."""
    if profile is None:
        return ShownMap(earth=earth_of())
    world = open_world(profile)
    roads = roads_of(world)
    if roads is None:
        return ShownMap(lambda: world.drawing, earth_of())
    geo = roads.road_map.geo
    return ShownMap(lambda: world.drawing, earth_of(geo.projection, (geo.offset_x_m, geo.offset_y_m)))


def route_points(profile: WorldProfile | None) -> tuple[tuple[float, float, float], ...]:
    """Return the route of a world as points (x m, y m, yaw rad); none without a world. Raises as open_world."""
    return () if profile is None else open_world(profile).route.points()


def route_length_m(profile: WorldProfile | None) -> float:
    """Return the length of a world's route, 0 without a world. Raises as open_world."""
    return 0.0 if profile is None else open_world(profile).route.length_m
