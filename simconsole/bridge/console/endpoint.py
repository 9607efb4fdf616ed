"""The console's side of the bridge: snapshots out, commands in, names as the profile wants them. No socket."""

from typing import Any, Final, NamedTuple

from simconsole.bridge.console.camera_topics import CameraTopics
from simconsole.bridge.console.command_decoder import CommandDecoder
from simconsole.bridge.console.counters import bridge_status, total_counts
from simconsole.bridge.console.input_slots import BridgeInputs, OnCommand, OnEvents
from simconsole.bridge.console.operator_acts import ACTS_MAX, OPERATE, OPERATE_TYPE, Act, OnAct, Operator
from simconsole.bridge.console.output_schedule import OutputSchedule, ScheduledOutput, topic_names
from simconsole.bridge.console.plan_input import AdviceInput, OnPlan, PlanInput
from simconsole.bridge.console.published_tick import PublishedTick
from simconsole.bridge.console.road_user_topics import RoadUserTopics
from simconsole.bridge.console.surroundings import NOWHERE, Surroundings
from simconsole.bridge.console.topics import CLOCK, GLOBAL_TOPICS, ODOMETRY, ROSOUT, ROSOUT_TYPE, Outputs
from simconsole.bridge.console.view_topics import view_topics
from simconsole.bridge.link.measurements import LateMeasurements
from simconsole.bridge.messages import Registry, standard_registry
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.lease import CommandDesk
from simconsole.bridge.protocol.rosapi import RosApi
from simconsole.bridge.protocol.server_protocol import Outcome, Router
from simconsole.bridge.protocol.topic_registry import Origin, Topic
from simconsole.control.requests.refusals import broken_limit
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.link import WayProfile
from simconsole.values.labels import arbitration_label, eased_label, is_eased
from simconsole.values.state_vector import LAYOUT, Snapshot

_IMPLAUSIBLE_AT: Final = LAYOUT.ros_link.at("implausible")
_OWN: Final = 0
"""The console itself as an origin: clients' sessions are numbered from 1."""


class _Measurement(NamedTuple):
    """One message on its way to the controllers."""

    output: ScheduledOutput
    t_ns: int
    message: Any  # None: nobody wants it


class ConsoleBridge:
    """Router, topic table and command slot of one console; server and lockstep bridge put sockets around it."""

    def __init__(
        self,
        profile: BridgeProfile,
        registry: Registry | None = None,
        on_command: OnCommand | None = None,
        on_events: OnEvents | None = None,
        on_act: OnAct | None = None,
        around: Surroundings = NOWHERE,
        on_plan: OnPlan | None = None,
        beside: "ConsoleBridge | None" = None,
    ) -> None:
        """Build the topics of `profile`.

        Args:
            profile: names, rates, limits.
            registry: message types; the standard ones without.
            on_command: sees each change of the command at once (`BridgeInputs`).
            on_events: sees each event at once.
            on_act: sees each act of an operator at once; without, they are kept until `take_acts`.
            around: what there is to tell of beside the state vector.
            on_plan: sees what a controller plans (`PlanInput`).
            beside: that of the session's first platform, whose server this further one shares.

        Raises:
            ProfileError: the profile renames or rates a topic that does not exist, or gives two topics one name.
        """
        self.profile = profile
        self.inputs = BridgeInputs(on_command, on_events)
        lease_ns = int(profile.lease_ms * 1e6)
        if beside is None:
            registry = registry if registry is not None else standard_registry()
            self.router = Router(registry, profile.limits, lease_ns, self.inputs.refuse)
            self.desk = self.router.desk
            RosApi(self.router)
        else:
            self.router = beside.router
            self.desk = CommandDesk(lease_ns, self.inputs.refuse)
            self.router.desks.append(self.desk)
        self._acts: list[Act] = []
        self.operator = Operator(self.inputs.raise_events, on_act or self._keep_act)
        self.router.calls.add_builtin(profile.namespace + OPERATE, OPERATE_TYPE, self.operator.operate, Role.CONTROL)
        self._command_decoder = CommandDecoder(self.inputs, profile, is_robot=around.robot is not None)
        self.desk.on_new_commander = self._command_decoder.forget_stamps
        self.desk.on_lost = self.inputs.lose
        self._now_ns = 0
        self._out = Outputs(
            self.router.registry,
            profile,
            lambda: bridge_status(self.router, self.desk, self._now_ns),
            around.route,
            around.signals,
            around.shown_map,
            around.robot,
        )
        outputs = (*view_topics(self.router.registry, profile, around.view), *self._out.topics())
        self._plans = PlanInput(profile, on_plan)
        commands = (*self._command_decoder.topics(), self._plans.topic(), AdviceInput(around.on_advice).topic())
        if around.road_users is not None:
            outputs = (*RoadUserTopics(self.router.registry, around.road_users).topics(), *outputs)
        if profile.camera is not None and around.camera is not None:
            outputs = (*outputs, *CameraTopics(self.router.registry, profile.camera, around.camera).topics())
        self.names = topic_names(profile, [*(topic.name for topic in outputs), *(topic.name for topic in commands)])
        if beside is not None:
            outputs = tuple(output for output in outputs if output.name != CLOCK)  # which the first one tells
        self._origin = None if beside is None else Origin(_OWN, profile.namespace.encode())
        self._schedule = OutputSchedule(outputs, self.names, profile)
        self._late = None if profile.link.measurements == WayProfile() else LateMeasurements[_Measurement](profile.link)
        self._newest_ns = 0  # stamp of the newest odometry that has gone out late
        self._topics = {output.name: self._topic(output) for output in self._schedule.outputs}
        if beside is None:
            self.router.add_shared(ROSOUT, ROSOUT_TYPE)
        self._eased = False  # it has been told
        self._happened: tuple[float, float, float, float] | None = None
        self._steering = around.steering
        self._implausible = 0.0  # as many commands have been refused by the arbiter so far
        for command in commands:
            self.router.add_command(self.names[command.name], command.type, command.accept, command.leased, self.desk)

    def _topic(self, output: ScheduledOutput) -> Topic:
        """Return the server's topic of an output: platforms have /tf and /tf_static together."""
        known = self.router.topic(output.name) if output.standard in GLOBAL_TOPICS else None
        if known is None:
            return self.router.add_output(output.name, output.type, latch=output.latched, shared=output.shared)
        known.depth += 1  # each platform's newest message is kept for a slow client
        return known

    def publish(self, snapshot: Snapshot, now_ns: int, *, odometry: bool = False) -> int | None:
        """Queue every message of `snapshot` that is due and wanted; with `odometry`, that in any case.

        Returns:
            The stamp in ns of the state that a controller answers now: that of `snapshot`, unless measurements come
            late; None: its odometry is lost, under way, or older than one that went out before.
        """
        self.keep_time(snapshot, now_ns)
        broken = self._broken_limit(snapshot)
        if broken:
            self.router.tell_commander(self.desk, "error", f"command not followed: {broken}", now_ns)
        tick = self._tell(snapshot, broken, now_ns)
        for output in self._schedule.due(snapshot, odometry=odometry):
            topic, message = self._topics[output.name], None
            if topic.subscribers or topic.latch:
                tick = tick or self._out.published_tick(snapshot)
                message = output.build(tick)
            if self._late is not None and output.measured:
                told = _Measurement(output, snapshot.t_ns, message)
                self._late.send(output.standard, snapshot.tick, snapshot.tick_hz, told)
            elif message is not None:
                self.router.topic_registry.distribute(topic, message, now_ns, self._origin if topic.latch else None)
        return snapshot.t_ns if self._late is None else self._tell_late(self._late, snapshot.tick, now_ns)

    def _tell_late(self, late: LateMeasurements[_Measurement], tick: int, now_ns: int) -> int | None:
        """Queue the measurements that arrive in this tick; return the newest odometry's stamp, None if none is new."""
        before = self._newest_ns
        for output, t_ns, message in late.arrived(tick):
            if message is not None:
                self.router.topic_registry.distribute(self._topics[output.name], message, now_ns)
            if output.standard == ODOMETRY:
                self._newest_ns = max(self._newest_ns, t_ns)
        return self._newest_ns if self._newest_ns > before else None

    def keep_time(self, snapshot: Snapshot, now_ns: int) -> None:
        """Take what time it is from a finished tick, without publishing anything."""
        self.operator.tick = snapshot.tick
        self.router.ros_time_ns = self._command_decoder.ros_time_ns = self._plans.now_ns = snapshot.t_ns
        self.router.calls.expire(now_ns)
        self._now_ns = now_ns

    def take_acts(self) -> list[Act]:
        """Return the acts since the last call."""
        acts, self._acts = self._acts, []
        return acts

    def _keep_act(self, act: Act) -> bool:
        room = len(self._acts) < ACTS_MAX
        if room:
            self._acts.append(act)
        return room

    def _broken_limit(self, snapshot: Snapshot) -> str:
        """Return why the arbiter has refused the ROS side's newest command since the last tick; empty: it has not."""
        if self._steering is None:
            return ""
        before, self._implausible = self._implausible, float(snapshot.vector[_IMPLAUSIBLE_AT])
        if self._implausible <= before:
            return ""
        return broken_limit(snapshot.ros, snapshot.vehicle, self._steering)

    def _tell(self, snapshot: Snapshot, broken: str, now_ns: int) -> PublishedTick | None:
        """Tell on /rosout what has changed; return the tick as published if anything has, and somebody listens."""
        if not self.router.has_subscribers(ROSOUT):
            return None
        torque = snapshot.torque
        if not self._eased and is_eased(torque.enabled, torque.car_share):
            self._eased = True
            tick = self._out.published_tick(snapshot)
            text = eased_label(torque.car_share)
            self.router.publish(ROSOUT, self._out.happening(tick, text, warns=True), now_ns)
        decided = snapshot.arbitration
        happened = (decided.mode, decided.reason, decided.refusal, snapshot.notice)
        if happened == self._happened:
            return None
        self._happened = happened
        tick = self._out.published_tick(snapshot)
        text, warns = arbitration_label(*happened, broken), bool(decided.refusal or snapshot.notice)
        self.router.publish(ROSOUT, self._out.happening(tick, text, warns=warns), now_ns)
        return tick

    def counts(self) -> dict[str, int]:
        """Return how many messages went to and from all clients."""
        return total_counts(self.router)

    def receive(self, session: ClientSession, text: bytes, now_ns: int) -> Outcome:
        """Apply one text of a client."""
        return self.router.receive(session, text, now_ns)

    def receive_plain(
        self, session: ClientSession, name: str, plain: dict[str, Any], now_ns: int, origin: Origin | None = None
    ) -> Outcome:
        """Apply one message of a topic that did not come as text."""
        return self.router.receive_plain(session, name, plain, now_ns, origin)

    def disconnect(self, session: ClientSession, now_ns: int) -> bool:
        """Remove a client; a platform that it commanded gets COMMANDER_LOST. Return whether there is one."""
        return self.router.disconnect(session, now_ns)
