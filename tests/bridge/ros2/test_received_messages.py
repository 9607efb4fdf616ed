from simconsole.bridge.ros2.graph_topics import ReceivedMessage
from simconsole.bridge.ros2.received_messages import (
    TOPIC_BYTES,
    TOPIC_MESSAGES,
    TURN_BYTES,
    TURN_MESSAGES,
    ReceivedMessages,
)


def message(topic: str, size: int = 1, node: str = "/n") -> ReceivedMessage:
    return ReceivedMessage(topic=topic, type="std_msgs/String", data=b"x" * size, node=node, latched_by=None)


def test_flooded_topic_loses_its_own_oldest_and_no_other_s() -> None:
    received = ReceivedMessages()
    received.put(message("/quiet"))
    for number in range(TOPIC_MESSAGES + 7):
        received.put(message("/flood", node=f"/n{number}"))
    assert received.take_dropped() == {"/flood": 7}
    assert received.take_dropped() == {}
    taken = received.take()
    assert [(each.topic, each.node) for each in taken[:3]] == [("/quiet", "/n"), ("/flood", "/n7"), ("/flood", "/n8")]


def test_large_messages_wait_up_to_a_bound_and_the_newest_in_any_case() -> None:
    received = ReceivedMessages()
    for size in (TOPIC_BYTES // 2, TOPIC_BYTES // 2, 1, 2 * TOPIC_BYTES):
        received.put(message("/picture", size))
    assert [len(each.data) for each in received.take()] == [2 * TOPIC_BYTES]
    assert received.take_dropped() == {"/picture": 3}
    received.put(message("/picture", TOPIC_BYTES))
    assert received.take_dropped() == {}


def test_what_is_taken_at_once_is_bounded_and_topics_take_turns() -> None:
    received = ReceivedMessages()
    for name in ("/a", "/b"):
        for _ in range(TURN_MESSAGES):
            received.put(message(name))
    taken = received.take()
    assert [each.topic for each in taken] == ["/a", "/b"] * (TURN_MESSAGES // 2)
    assert received.waits
    assert len(received.take()) == TURN_MESSAGES
    assert not received.waits
    for _ in range(3):
        received.put(message("/c", TURN_BYTES))
    assert len(received.take()) == 1
