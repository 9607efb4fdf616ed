"""What a drive's bridge tells of, or knows, beside the state vector."""

from typing import Final, NamedTuple

from simconsole.bridge.console.camera_topics import ReadCamera
from simconsole.bridge.console.plan_input import OnAdvice
from simconsole.bridge.console.published_tick import RobotTable
from simconsole.bridge.console.road_user_topics import ReadRoadUsers
from simconsole.bridge.console.topics import Route
from simconsole.bridge.console.view_topics import NO_VIEW, ExternalView
from simconsole.control.requests.refusals import SteeringLimit
from simconsole.world.rules.road_signals import RoadSignals
from simconsole.world.world import NO_MAP, ShownMap


class Surroundings(NamedTuple):
    """World, traffic, camera, view and limits of a drive."""

    route: Route = ()  # what /route shows
    shown_map: ShownMap = NO_MAP
    signals: RoadSignals | None = None  # the traffic lights of the world; None where it has none
    road_users: ReadRoadUsers | None = None  # returns the newest; None: they have no topics
    camera: ReadCamera | None = None  # returns the newest picture; None: there is no camera
    view: ExternalView = NO_VIEW  # what the topics of `external_view` show
    robot: RobotTable | None = None  # makes the topics of what is driven, where it is a robot
    steering: SteeringLimit | None = None  # beyond it the arbiter refuses a command, and its sender is told so
    on_advice: OnAdvice | None = None  # sees what speed advice a controller goes by


NOWHERE: Final = Surroundings()
