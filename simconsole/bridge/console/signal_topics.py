"""The messages about traffic lights: what each shows now and next, and where its stop lines are."""

from typing import Any, Final

from simconsole.bridge.console.published_tick import MAP_FRAME, ONCE, OutputTopic, PublishedTick, quaternion
from simconsole.bridge.messages import Registry
from simconsole.world.rules.road_signals import RoadSignals, StopLinePlace

SIGNALS: Final = "/traffic_signals"
SIGNALS_TYPE: Final = "simconsole_msgs/TrafficSignals"
STOP_LINES: Final = "/traffic_signals/stop_lines"
_SIGNALS_HZ: Final = 10.0  # as the road side sends its SPAT messages
_TYPES: Final = ("TrafficSignals", "TrafficSignal", "StopLines", "StopLine")
_GEOMETRY: Final = ("Pose", "Point", "Quaternion")


class SignalTopics:
    """Builds them; in a world without traffic lights they are empty."""

    def __init__(self, registry: Registry, signals: RoadSignals | None) -> None:
        self._signals = signals
        self._types: dict[str, Any] = {name: registry.struct(f"simconsole_msgs/{name}") for name in _TYPES}
        self._types |= {name: registry.struct(f"geometry_msgs/{name}") for name in _GEOMETRY}

    def topics(self) -> tuple[OutputTopic, ...]:
        """Return their rows of the table of output topics."""
        return (
            OutputTopic(STOP_LINES, "simconsole_msgs/StopLines", ONCE, self._stop_lines),
            OutputTopic(SIGNALS, SIGNALS_TYPE, _SIGNALS_HZ, self._shown, measured=True),
        )

    def _shown(self, tick: PublishedTick) -> Any:
        vehicle, found = tick.vehicle, []
        if self._signals is not None:
            found = self._signals.in_reach(vehicle.x_m, vehicle.y_m, tick.snapshot.tick)
        signals = [self._types["TrafficSignal"](*one) for one in found]
        return self._types["TrafficSignals"](tick.header(MAP_FRAME), signals)

    def _stop_lines(self, tick: PublishedTick) -> Any:
        lines = () if self._signals is None else self._signals.stop_lines
        return self._types["StopLines"](tick.header(MAP_FRAME), [self._stop_line(line) for line in lines])

    def _stop_line(self, line: StopLinePlace) -> Any:
        types = self._types
        turn = types["Quaternion"](*quaternion(0.0, 0.0, line.yaw_rad))
        pose = types["Pose"](types["Point"](line.x_m, line.y_m), turn)
        return types["StopLine"](line.lane, line.signal, list(line.links), pose, line.width_m)
