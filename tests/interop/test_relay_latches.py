"""What nodes latch reaches every client, whenever it comes; against a real rclpy."""

from tests.interop.programs import Client, client
from tests.interop.puppets import puppet, served
from tests.interop.ros2 import domain, needs_ros2
from tests.patience import wait_until

pytestmark = needs_ros2


def subscribe(web: Client) -> None:
    web.say(op="subscribe", topic="/map", type="std_msgs/String")


def test_latched_topics_reach_every_later_subscriber() -> None:
    around = domain()
    with served(around) as console, puppet(around, "one") as one, puppet(around, "two") as two:
        one.do("publish", name="/map", data="first", latched=True)
        one.do("publish", name="/map", data="second", latched=True)
        two.do("publish", name="/map", data="other", latched=True)
        with client(console.url) as first, client(console.url) as second:
            subscribe(first)
            assert {first.message("/map")["data"] for _ in range(2)} == {"second", "other"}
            subscribe(second)
            assert {second.message("/map")["data"] for _ in range(2)} == {"second", "other"}
            first.say(op="unsubscribe", topic="/map")
            second.say(op="unsubscribe", topic="/map")
            one.do("publish", name="/map", data="third", latched=True)  # while nobody here listens
        with client(console.url) as late:
            subscribe(late)
            heard: list[str] = []
            while not {"third", "other"} <= set(heard):  # what is kept here comes first, then what the graph brings
                heard.append(late.message("/map")["data"])
            assert set(heard) <= {"second", "third", "other"}
            assert "second" not in heard[heard.index("third") :]
            two.do("destroy", kind="publisher", name="/map")

            def is_gone() -> bool:
                with client(console.url) as web:
                    subscribe(web)
                    found = [web.message("/map")["data"]]
                    web.say(op="call_service", id="end", service="/rosapi/get_time")
                    while (heard := web.hear(lambda heard: True)).get("id") != "end":
                        found.append(heard["msg"]["data"])
                    return found == ["third"]

            wait_until(is_gone, "the end of a publisher")
