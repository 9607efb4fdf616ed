"""The console as a node of the bus, without the bus: frames out of a snapshot, commands out of frames."""

from typing import Final, NamedTuple

from simconsole.canbus.codec import COMMAND, CONSOLE, ECU, Codec, Frame
from simconsole.canbus.messages import BUILDERS, COMMAND_KIND, REQUESTS, Link, MessageContext
from simconsole.canbus.protection import COUNTERS, Check, Receiver
from simconsole.canbus.schedule import Schedule
from simconsole.profiles.can import CanProfile
from simconsole.values.errors import CanError
from simconsole.values.signals import NO_COMMAND, Event
from simconsole.values.state_vector import Snapshot

_NEVER_MS: Final = 1e9
_NS_PER_MS: Final = 1e6


class NodeCounters(NamedTuple):
    """What a node has done since the start."""

    sent: int
    unsent: int
    """Messages not built because a value was not finite."""
    missed: int
    accepted: int
    refused: int
    lost: int


class CanNode:
    """The console's node. Times are ns of one monotonic clock, given by the caller.

    Attributes:
        tick_hz: control ticks per second.
        command: the newest accepted command (age 0), its sequence, and the refused ones counted.
        receipt_ns: when it came, None before the first.
        transmit_ids: the whitelist of what this node may send.
        receive_ids: the whitelist of what it looks at.
    """

    def __init__(
        self,
        codec: Codec,
        profile: CanProfile,
        tick_hz: int,
        *,
        wheels: tuple[int, ...] | None = None,
    ) -> None:
        """Build the node.

        Args:
            codec: the messages.
            profile: time-out, counter step, bad frames in a row.
            tick_hz: control ticks per second.
            wheels: where a state vector holds the four wheels' speeds (messages.wheel_columns).
        """
        self._codec = codec
        self._wheels = wheels
        self.tick_hz = tick_hz
        self._messages = [info for info in codec.sent_by(CONSOLE) if wheels is not None or info.name != "SC_WHEELS"]
        self._schedule = Schedule([info.period_ms for info in self._messages], tick_hz)
        self._counters = [0] * len(self._messages)
        timeout_ns = round(profile.command_timeout_ms * _NS_PER_MS)
        self._receiver = Receiver(
            codec.messages[COMMAND].can_id, timeout_ns, profile.counter_step_max, profile.invalid_max
        )
        self._request: int | None = None
        self._sent = self._unsent = self._accepted = 0
        self.transmit_ids = codec.ids(CONSOLE)
        self.receive_ids = codec.ids(ECU)
        self.command = NO_COMMAND
        self.receipt_ns: int | None = None

    def transmit(self, snapshot: Snapshot, now_ns: int) -> list[Frame]:
        """Return the frames that are due with this snapshot."""
        due = self._schedule.due(snapshot.tick)
        if not due:
            return []
        context = MessageContext(snapshot, snapshot.vehicle, snapshot.driver, self._link(now_ns), self._wheels)
        frames = []
        for index in due:
            name = self._messages[index].name
            try:
                frames.append(self._codec.encode(name, BUILDERS[name](context), self._counters[index], clip=True))
            except CanError:  # a value is not finite: no valid frame can be sent
                self._unsent += 1
                continue
            self._counters[index] = (self._counters[index] + 1) % COUNTERS
        self._sent += len(frames)
        return frames

    def next_tick(self, tick: int) -> int:
        """Return the next tick after `tick` at which a message is due; a second later where none is scheduled."""
        due = self._schedule.next_tick()
        return tick + self.tick_hz if due is None else max(tick + 1, due)

    def receive(self, frame: Frame, now_ns: int) -> int:
        """Take a frame; return the events (mask) that it raised. Frames of other ids are ignored."""
        if frame.extended or self._codec.by_id.get(frame.can_id) != COMMAND:
            return 0
        if self._receiver.look(now_ns) is Check.NO_NEW_DATA:
            self._request = None
        state = self._receiver.take(frame.data, now_ns)
        if state is Check.NO_NEW_DATA:  # the first frame only gives the counter's value
            return 0
        if state is not Check.OK:
            self._refuse()
            return 0
        values = self._codec.decode(COMMAND, frame.data)
        if values is None:
            self._receiver.state = Check.OUT_OF_RANGE
            self._refuse()
            return 0
        self._accepted += 1
        self.receipt_ns = now_ns
        self.command = NO_COMMAND._replace(
            kind=COMMAND_KIND,
            sequence=self.command.sequence + 1.0,
            refused=self.command.refused,
            age_ticks=0.0,
            road_wheel_rad=values["ROAD_WHEEL"],
            accel_mps2=values["ACCEL"],
            direction=values["DIRECTION"],
            turn_indicators=values["TURN_INDICATORS"],
            hazard_lights=values["HAZARD_LIGHTS"],
        )
        return self._asked(int(values["REQUEST"]))

    def state(self, now_ns: int) -> Check:
        """Return how the command is being received."""
        return self._receiver.look(now_ns)

    def counters(self) -> NodeCounters:
        """Return what this node has done."""
        receiver = self._receiver
        refused = int(self.command.refused)
        return NodeCounters(
            sent=self._sent,
            unsent=self._unsent,
            missed=sum(self._schedule.missed),
            accepted=self._accepted,
            refused=refused,
            lost=receiver.lost,
        )

    def _asked(self, request: int) -> int:
        """Return the event of a request that has changed. One that was set when reception (re)started is no change.

        An emergency stop counts even then.
        """
        before, self._request = self._request, request
        event = REQUESTS.get(request, Event(0))
        if event is Event.EMERGENCY_STOP:
            return 0 if request == before else int(event)
        if before is None or request == before:
            return 0
        return int(event)

    def _refuse(self) -> None:
        self.command = self.command._replace(refused=self.command.refused + 1.0)

    def _link(self, now_ns: int) -> Link:
        age_ms = _NEVER_MS if self.receipt_ns is None else (now_ns - self.receipt_ns) / _NS_PER_MS
        return Link(float(self._receiver.look(now_ns)), max(0.0, age_ms))
