import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.surroundings import Surroundings
from simconsole.control.requests.refusals import SteeringLimit
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.link import LinkProfile, WayProfile
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Event, Link, LinkState, Notice, Reason, RemoteCommand
from simconsole.values.state_vector import LAYOUT

MS = 1_000_000
CONTROL = "/control/command/control_cmd"


def test_namespace_goes_before_all_but_the_global_topics() -> None:
    names = ConsoleBridge(BridgeProfile(namespace="/ego")).names
    assert names["/odom"] == "/ego/odom"
    assert names[CONTROL] == "/ego/control/command/control_cmd"
    assert [names[name] for name in ("/clock", "/tf", "/tf_static")] == ["/clock", "/tf", "/tf_static"]


def test_renamed_topics_work_both_ways(
    join: Callable[..., Any], snapshot: Callable[..., Any], control: Callable[..., Any]
) -> None:
    profile = BridgeProfile(namespace="/ego", rename={"/odom": "/car/state", CONTROL: "/drive"})
    peer = join(ConsoleBridge(profile))
    peer.send(op="subscribe", topic="/car/state", type="nav_msgs/Odometry")
    peer.bridge.publish(snapshot(5), 0)
    assert [message["topic"] for message in peer.heard()] == ["/car/state"]
    assert peer.publish("/drive", control()).kind == "command"
    assert peer.publish(CONTROL, control()).kind == "refused"


@pytest.mark.parametrize(
    ("profile", "complaint"),
    [
        (BridgeProfile(rename={"/odometry": "/x"}), "outputs.bridge.rename: /odometry is no topic"),
        (BridgeProfile(rename={"/odom": "/clock"}), "would both be /clock"),
        (BridgeProfile(rates_hz={"/cmd_vel": 10.0}), "outputs.bridge.rates_hz: /cmd_vel is no topic"),
    ],
)
def test_profile_that_cannot_be_meant(profile: BridgeProfile, complaint: str) -> None:
    with pytest.raises(ProfileError, match=complaint):
        ConsoleBridge(profile)


def test_rates_of_the_profile(join: Callable[..., Any], snapshot: Callable[..., Any]) -> None:
    peer = join(ConsoleBridge(BridgeProfile(rates_hz={"/odom": 10.0, "/clock": 0.0})))
    assert peer.send(op="subscribe", topic="/clock").kind == "refused"
    peer.send(op="subscribe", topic="/odom", queue_length=1000)
    for tick in range(1, 251):
        peer.bridge.publish(snapshot(tick), 0)
    assert [message["op"] for message in peer.heard()] == ["status", *["publish"] * 10]


def test_state_topics_keep_the_newest_for_a_slow_client(peer: Any, snapshot: Callable[..., Any]) -> None:
    peer.send(op="subscribe", topic="/odom")
    for tick in range(1, 101):
        peer.bridge.publish(snapshot(tick, x_m=float(tick)), 0)
    (message,) = peer.heard()
    assert message["msg"]["pose"]["pose"]["position"]["x"] == 100.0
    assert peer.session.send_queue.dropped == 19


def test_odometry_can_be_asked_for_out_of_turn(peer: Any, snapshot: Callable[..., Any]) -> None:
    for topic in ("/odom", "/ground_truth/odom"):
        peer.send(op="subscribe", topic=topic)
    peer.bridge.publish(snapshot(4), 0, odometry=True)
    assert [message["topic"] for message in peer.heard()] == ["/odom"]


def test_measurements_go_over_the_link_and_what_the_console_decides_does_not(
    join: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    link = LinkProfile(measurements=WayProfile(delay_ms=40.0))
    peer = join(ConsoleBridge(BridgeProfile(link=link)))
    for topic in ("/odom", "/tf", "/imu/data", "/console/arbitration", "/clock"):
        peer.send(op="subscribe", topic=topic, queue_length=1000)
    assert peer.send(op="subscribe", topic="/ground_truth/odom").kind == "refused", "it would tell all at once"
    peer.heard()
    due = []
    for tick in range(1, 61):
        due.append(peer.bridge.publish(snapshot(tick, x_m=float(tick)), 0))
        for heard in peer.heard():
            head = heard["msg"].get("header", heard["msg"])
            if "transforms" in head:
                head = head["transforms"][0]["header"]
            stamp = head.get("stamp", head.get("clock"))
            late = 0 if heard["topic"] in ("/console/arbitration", "/clock") else 10
            assert stamp["nanosec"] == (tick - late) * 4 * MS, heard["topic"]
            if heard["topic"] == "/odom":
                assert heard["msg"]["pose"]["pose"]["position"]["x"] == tick - 10.0
    assert due == [(tick - 10) * 4 * MS if tick % 5 == 0 and tick > 10 else None for tick in range(1, 61)]


def test_nobody_need_answer_an_odometry_that_is_lost_or_overtaken(snapshot: Callable[..., Any]) -> None:
    way = WayProfile(jitter_ms=80.0, loss_share=0.2)
    bridge = ConsoleBridge(BridgeProfile(link=LinkProfile(seed=3, measurements=way)))
    due = [bridge.publish(snapshot(tick), 0, odometry=True) for tick in range(5, 5000, 5)]
    asked = [stamp_ns for stamp_ns in due if stamp_ns is not None]
    assert asked == sorted(set(asked))
    assert 300 < len(asked) < 799


def test_equal_drives_send_equal_bytes(join: Callable[..., Any], snapshot: Callable[..., Any]) -> None:
    def drive() -> list[bytes]:
        peer = join(ConsoleBridge(BridgeProfile()))
        for topic in ("/odom", "/tf", "/console/arbitration", "/clock"):
            peer.send(op="subscribe", topic=topic)
        texts = []
        for tick in range(1, 51):
            peer.bridge.publish(snapshot(tick, x_m=tick / 3, yaw_rad=tick / 7), 0)
            while (text := peer.session.next_text(0)) is not None:
                texts.append(text)
        return texts

    first = drive()
    assert len(first) == 50
    assert first == drive()


def test_vanished_commander_is_an_event_and_another_can_take_over(
    bridge: ConsoleBridge, join: Callable[..., Any], control: Callable[..., Any]
) -> None:
    first, second = join(bridge), join(bridge)
    first.publish(CONTROL, control(0.1))
    assert bridge.disconnect(first.session, 1)
    command, events = bridge.inputs.take(1)
    assert events.events == Event.COMMANDER_LOST
    assert command.road_wheel_rad == 0.1
    assert second.publish(CONTROL, control(0.2)).kind == "command"
    assert bridge.inputs.take(2)[0].road_wheel_rad == 0.2


def test_watcher_that_goes_is_no_event(
    bridge: ConsoleBridge, join: Callable[..., Any], control: Callable[..., Any]
) -> None:
    driver, watcher = join(bridge), join(bridge)
    driver.publish(CONTROL, control())
    assert not bridge.disconnect(watcher.session, 1)
    assert not bridge.disconnect(driver.session, 500 * MS)
    assert bridge.inputs.take(1)[1].events == 0.0


def test_rosout_tells_what_changes_to_whoever_listens(
    bridge: ConsoleBridge, join: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    listener, node = join(bridge), join(bridge)
    bridge.publish(snapshot(1), 0)
    listener.send(op="subscribe", topic="/rosout")
    for tick, mode in ((2, 0.0), (3, 0.0), (4, 3.0)):
        bridge.publish(snapshot(tick, mode=mode), 0)
    told = [message["msg"] for message in listener.heard()]
    assert [(said["name"], said["level"], said["msg"].partition(":")[0]) for said in told] == [
        ("simconsole", 20, "PARKED"),
        ("simconsole", 20, "AUTONOMOUS"),
    ]
    log = {"level": 30, "name": "planner", "msg": "hello"}
    assert node.publish("/rosout", log, type="rcl_interfaces/msg/Log").kind == "done"
    assert [message["msg"]["msg"] for message in listener.heard()] == ["hello"]
    node.send(op="unadvertise", topic="/rosout")
    listener.send(op="unsubscribe", topic="/rosout")
    assert bridge.router.topics["/rosout"].type == "rcl_interfaces/msg/Log"


def test_rosout_warns_once_of_a_wheel_that_bears_a_share_of_the_cars_torque_only(
    bridge: ConsoleBridge, join: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    listener = join(bridge)
    listener.send(op="subscribe", topic="/rosout")
    for tick, share in enumerate((1.0, 0.74, 0.6), 1):
        shot = snapshot(tick)
        shot.vector[LAYOUT.torque.at("enabled")] = 1.0
        shot.vector[LAYOUT.torque.at("car_share")] = share
        bridge.publish(shot, 0)
    told = [(message["msg"]["level"], message["msg"]["msg"]) for message in listener.heard()]
    assert told[1:] == [(30, "force feedback eased to 74 %")]


def test_rosout_warns_once_that_traffic_is_lost(
    bridge: ConsoleBridge, join: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    listener = join(bridge)
    listener.send(op="subscribe", topic="/rosout")
    for tick in (1, 2, 3):
        shot = snapshot(tick)
        shot.vector[LAYOUT.ahead.at("traffic_lost")] = float(tick > 1)
        bridge.publish(shot, 0)
    told = [(message["msg"]["level"], message["msg"]["msg"]) for message in listener.heard()]
    assert len(told) == 2
    assert told[1][0] == 30
    assert told[1][1].endswith("traffic has failed: the road is empty")


def test_a_controller_that_nobody_asked_for_is_told(
    bridge: ConsoleBridge, join: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    listener = join(bridge)
    listener.send(op="subscribe", topic="/console/arbitration")
    listener.send(op="subscribe", topic="/rosout")
    commanded = snapshot(5)
    commanded.vector[LAYOUT.ros_link.start + Link._fields.index("state")] = float(LinkState.STEADY)
    bridge.publish(commanded, 0)
    heard = {message["topic"]: message["msg"] for message in listener.heard()}
    assert heard["/console/arbitration"]["notice"] == Notice.NOT_ENGAGED
    assert heard["/console/arbitration"]["notice_words"] == "parked: nobody has asked for autonomy"
    assert (heard["/rosout"]["level"], heard["/rosout"]["msg"].endswith("asked for autonomy")) == (30, True)


def test_route_is_there_for_whoever_comes_later(join: Callable[..., Any], snapshot: Callable[..., Any]) -> None:
    bridge = ConsoleBridge(BridgeProfile(), around=Surroundings(route=[(1.0, 2.0, 0.0), (1.0, 4.0, math.pi / 2.0)]))
    bridge.publish(snapshot(1), 0)
    late = join(bridge)
    late.send(op="subscribe", topic="/route", type="nav_msgs/Path")
    (heard,) = late.heard()
    path = heard["msg"]
    assert path["header"]["frame_id"] == "map"
    assert [(each["pose"]["position"]["x"], each["pose"]["position"]["y"]) for each in path["poses"]] == [
        (1, 2),
        (1, 4),
    ]
    assert path["poses"][1]["pose"]["orientation"]["z"] == pytest.approx(math.sqrt(0.5))


def test_the_commander_and_rosout_are_told_which_limit_a_command_has_broken(
    join: Callable[..., Any], snapshot: Callable[..., Any], control: Callable[..., Any]
) -> None:
    bridge = ConsoleBridge(BridgeProfile(port=0), around=Surroundings(steering=SteeringLimit(10.0, 2.5)))
    driver, listener = join(bridge), join(bridge)
    listener.send(op="subscribe", topic="/rosout")
    driver.publish(CONTROL, control(0.5))
    seen = {"mode": 3.0, "kind": 1.0, "vx_mps": 10.0, "sequence": 1.0}
    refused_at = LAYOUT.ros_link.start + Link._fields.index("implausible")
    angle_at = LAYOUT.ros.start + RemoteCommand._fields.index("road_wheel_rad")
    for tick, count, refusal in ((1, 0.0, 0.0), (2, 1.0, float(Reason.REFUSED_IMPLAUSIBLE)), (3, 1.0, 0.0)):
        state = snapshot(tick, **seen, refusal=refusal)
        state.vector[refused_at], state.vector[angle_at] = count, 0.5
        bridge.publish(state, 0)
    broken = "lateral acceleration of 21.9 m/s2 at 10.0 m/s, at most 10 m/s2"
    assert driver.statuses() == [f"command not followed: {broken}"]
    told = [message["msg"] for message in listener.heard()]
    assert [(said["level"], said["msg"]) for said in told] == [
        (20, "AUTONOMOUS: drive started"),
        (30, f"AUTONOMOUS: drive started; refused: too much lateral acceleration ({broken})"),
        (20, "AUTONOMOUS: drive started"),
    ]


def test_platforms_of_a_session_have_a_commander_and_topics_each_and_tf_together(
    join: Callable[..., Any], snapshot: Callable[..., Any], control: Callable[..., Any]
) -> None:
    first = ConsoleBridge(BridgeProfile(port=0, namespace="/one"))
    second = ConsoleBridge(BridgeProfile(port=0, namespace="/two"), beside=first)
    one, two, viewer = join(first), join(second), join(first)
    assert one.publish("/one" + CONTROL, control(0.1)).kind == "command"
    assert two.publish("/two" + CONTROL, control(0.2)).kind == "command"
    assert (first.inputs.take(1)[0].road_wheel_rad, second.inputs.take(1)[0].road_wheel_rad) == (0.1, 0.2)
    for topic in ("/tf", "/clock", "/one/odom", "/two/odom"):
        viewer.send(op="subscribe", topic=topic)
    first.publish(snapshot(5), 0)
    second.publish(snapshot(5), 0)
    heard = [message["topic"] for message in viewer.heard()]
    assert sorted(heard) == ["/clock", "/one/odom", "/tf", "/tf", "/two/odom"]
    assert two.publish("/one" + CONTROL, control(0.3)).kind == "refused", "somebody else's"
    assert two.send("no message").kind == "refused"
    assert (first.inputs.take(2)[0].refused, second.inputs.take(2)[0].refused) == (0.0, 1.0)


def test_a_limit_that_a_command_has_broken_is_told_to_nobody_where_its_sender_is_gone(
    join: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    bridge = ConsoleBridge(BridgeProfile(port=0), around=Surroundings(steering=SteeringLimit(10.0, 2.5)))
    listener = join(bridge)
    state = snapshot(1, mode=3.0, kind=1.0, vx_mps=10.0, sequence=1.0, refusal=float(Reason.REFUSED_IMPLAUSIBLE))
    state.vector[LAYOUT.ros_link.start + Link._fields.index("implausible")] = 1.0
    state.vector[LAYOUT.ros.start + RemoteCommand._fields.index("road_wheel_rad")] = 0.5
    bridge.publish(state, 0)
    assert listener.statuses() == []
