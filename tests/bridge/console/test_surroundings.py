from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.surroundings import NOWHERE, Surroundings
from simconsole.profiles.bridge import BridgeProfile
from simconsole.world.traffic.road_users import NOBODY, RoadUsersAt

TRAFFIC = {"/road_users", "/road_users/detections"}


def test_nowhere_there_is_nobody_to_tell_of() -> None:
    assert TRAFFIC.isdisjoint(ConsoleBridge(BridgeProfile(port=0)).names)
    assert ConsoleBridge(BridgeProfile(port=0), around=NOWHERE).names == ConsoleBridge(BridgeProfile(port=0)).names


def test_what_is_around_has_its_topics() -> None:
    around = Surroundings(road_users=lambda: RoadUsersAt(0, NOBODY))
    told = set(ConsoleBridge(BridgeProfile(port=0), around=around).names)
    assert told - set(ConsoleBridge(BridgeProfile(port=0)).names) == TRAFFIC
