"""A small relay between a ROS 1 graph and a rosbridge server: an ordinary client of both. Runs with Debian's python3.

`python3 ros1_relay.py URL SITE MESSAGES TABLE`: SITE has websockets in it, MESSAGES packages made by genpy; TABLE is
JSON of four maps from names to ROS 1 types: topics `out` of the bridge and `in` to it, services `offered` by the bridge
to ROS and `called` by the bridge in ROS.
"""

import importlib
import json
import sys
import threading
from queue import SimpleQueue
from typing import Any

URL, SITE, MESSAGES, TABLE = sys.argv[1:5]
sys.path[:0] = [MESSAGES]
sys.path.append(SITE)

import genpy  # noqa: E402  # found only now
import rospy  # noqa: E402
from websockets.sync.client import connect  # noqa: E402

PATIENCE_S = 600.0  # of tests/patience.py, which this program cannot import: it ends only what hangs


def load(type_name: str, kind: str) -> Any:
    package, _, name = type_name.partition("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), name)


def plain(value: Any) -> Any:
    if isinstance(value, (genpy.Time, genpy.Duration)):
        return {"secs": value.secs, "nsecs": value.nsecs}
    if isinstance(value, genpy.Message):
        return {name: plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return value


def filled(kind: Any, values: Any) -> Any:
    message = kind()
    genpy.message.fill_message_args(message, [values])
    return message


class Relay:
    def __init__(self, web: Any, table: Any) -> None:
        self._web = web
        self._lock = threading.Lock()
        self._publishers: dict[str, Any] = {}
        self._proxies: dict[str, Any] = {}
        self._answers: dict[Any, Any] = {}
        self._numbers = 0
        for topic, name in table["out"].items():
            self._publishers[topic] = rospy.Publisher(topic, load(name, "msg"), queue_size=10)
            self.say(op="subscribe", topic=topic, type=name)
        for topic, name in table["in"].items():
            self.say(op="advertise", topic=topic, type=name)
            rospy.Subscriber(topic, load(name, "msg"), self._hear, topic, queue_size=10)
        for service, name in table["offered"].items():
            rospy.Service(service, load(name, "srv"), lambda request, service=service: self._ask(service, request))
        for service, name in table["called"].items():
            self._proxies[service] = rospy.ServiceProxy(service, load(name, "srv"))
            self.say(op="advertise_service", service=service, type=name)

    def say(self, **operation: Any) -> None:
        with self._lock:
            self._web.send(json.dumps(operation))

    def run(self) -> None:
        for text in self._web:
            said = json.loads(text)
            if said["op"] == "publish":
                publisher = self._publishers[said["topic"]]
                publisher.publish(filled(publisher.data_class, said["msg"]))
            elif said["op"] == "call_service":
                threading.Thread(target=self._call, args=(said,), daemon=True).start()
            elif said["op"] == "service_response":
                self._answers.pop(said["id"]).put(said)
            else:
                print(text, file=sys.stderr, flush=True)

    def _hear(self, message: Any, topic: str) -> None:
        self.say(op="publish", topic=topic, msg=plain(message))

    def _ask(self, service: str, request: Any) -> Any:
        self._numbers += 1
        key = f"ros1:{self._numbers}"
        answer = self._answers[key] = SimpleQueue()
        self.say(op="call_service", service=service, id=key, args=plain(request))
        said = answer.get(timeout=PATIENCE_S)
        if not said["result"]:
            raise rospy.ServiceException(said["values"])
        return said["values"]

    def _call(self, said: Any) -> None:
        proxy = self._proxies[said["service"]]
        try:
            proxy.wait_for_service(timeout=PATIENCE_S)
            values, result = plain(proxy(filled(proxy.request_class, said["args"]))), True
        except (rospy.ServiceException, rospy.ROSException) as error:
            values, result = str(error), False
        self.say(op="service_response", service=said["service"], id=said["id"], values=values, result=result)


if __name__ == "__main__":
    rospy.init_node("relay", disable_signals=True)
    with connect(f"{URL}/ros1") as web:
        Relay(web, json.loads(TABLE)).run()
