"""An ECU under test: reads the console's messages, holds a speed, asks for autonomy. Without the bus.

`simconsole can send` and the tests use it as the other end of the bus; on a test rig a real ECU takes its place.
"""

from typing import Final, NamedTuple

from simconsole.canbus.codec import COMMAND, CONSOLE, ECU, Codec, Frame
from simconsole.canbus.protection import Check, Receiver
from simconsole.values.signals import Mode

_TIMEOUT_PERIODS: Final = 10
_NS_PER_MS: Final = 1_000_000
_SPEED_GAIN_PER_S: Final = 0.8
_ASK_FRAMES: Final = 10
"""Frames between two requests: the console needs steady commands for a while before it engages."""


class Heard(NamedTuple):
    """What became of one frame; values only of an OK one."""

    name: str
    state: Check
    values: dict[str, float] | None


class Listener:
    """Follows every message of one node."""

    def __init__(self, codec: Codec, sender: str | None = None) -> None:
        """Listen to `sender`, or to all."""
        self._codec = codec
        self._receivers = {
            info.can_id: Receiver(info.can_id, _TIMEOUT_PERIODS * info.period_ms * _NS_PER_MS)
            for info in codec.messages.values()
            if sender in (None, info.sender)
        }

    @property
    def ids(self) -> frozenset[int]:
        """The ids listened to."""
        return frozenset(self._receivers)

    def take(self, frame: Frame, now_ns: int) -> Heard | None:
        """Judge and decode a frame that came at `now_ns`; None if its id is not listened to."""
        receiver = self._receivers.get(frame.can_id)
        if receiver is None or frame.extended:
            return None
        name = self._codec.by_id[frame.can_id]
        state = receiver.take(frame.data, now_ns)
        if state is not Check.OK:
            return Heard(name, state, None)
        values = self._codec.decode(name, frame.data)
        return Heard(name, state if values is not None else Check.OUT_OF_RANGE, values)

    def lost(self) -> int:
        """Return how many frames the counters say were lost."""
        return sum(receiver.lost for receiver in self._receivers.values())


class Wish(NamedTuple):
    """What the ECU shall do: an acceleration, or a speed to hold, along the direction of travel."""

    road_wheel_rad: float = 0.0
    accel_mps2: float = 0.0
    speed_mps: float | None = None
    accel_max_mps2: float = 2.0
    direction: float = 1.0
    turn_indicators: float = 0.0
    hazard_lights: float = 0.0
    engage: bool = False
    request: int = 0


class Ecu:
    """The ECU's node.

    Attributes:
        mode: who drives, as SC_STATUS last said; None before the first.
        speed_mps: as SC_MOTION last said; None before the first.
    """

    def __init__(self, codec: Codec, wish: Wish) -> None:
        """Build it; `transmit_ids` and `receive_ids` are its whitelists."""
        self._codec = codec
        self._wish = wish
        self._listener = Listener(codec, CONSOLE)
        self._frames = 0
        self.transmit_ids = codec.ids(ECU)
        self.receive_ids = codec.ids(CONSOLE)
        self.mode: int | None = None
        self.speed_mps: float | None = None

    def receive(self, frame: Frame, now_ns: int) -> None:
        """Take a frame of the console."""
        heard = self._listener.take(frame, now_ns)
        if heard is None or heard.values is None:
            return
        if heard.name == "SC_STATUS":
            self.mode = int(heard.values["MODE"])
        elif heard.name == "SC_MOTION":
            self.speed_mps = heard.values["SPEED"]

    def command(self) -> Frame:
        """Return the next ECU_COMMAND; call it once a period.

        Raises:
            CanError: a value of the wish is out of the message's range.
        """
        wish = self._wish
        values = {
            "REQUEST": float(self._request()),
            "ROAD_WHEEL": wish.road_wheel_rad,
            "ACCEL": self._accel_mps2(),
            "DIRECTION": wish.direction,
            "TURN_INDICATORS": wish.turn_indicators,
            "HAZARD_LIGHTS": wish.hazard_lights,
        }
        frame = self._codec.encode(COMMAND, values, self._frames % 16)
        self._frames += 1
        return frame

    def _accel_mps2(self) -> float:
        wish = self._wish
        if wish.speed_mps is None:
            return wish.accel_mps2
        if self.speed_mps is None:
            return 0.0
        along_mps = self.speed_mps * (-1.0 if wish.direction < 0.0 else 1.0)
        wanted = _SPEED_GAIN_PER_S * (wish.speed_mps - along_mps)
        return min(max(wanted, -wish.accel_max_mps2), wish.accel_max_mps2)

    def _request(self) -> int:
        """Return the request: it acts on a change, so it is sent in every second block of frames until granted."""
        asking = self._frames // _ASK_FRAMES % 2 == 1
        if not self._wish.engage:
            return self._wish.request if asking or self._frames >= 2 * _ASK_FRAMES else 0
        return 1 if asking and self.mode != Mode.AUTONOMOUS else 0
