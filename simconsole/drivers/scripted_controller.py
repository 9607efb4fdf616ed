"""A scripted controller: the remote commands and events of a scenario, tick by tick. Pure."""

from collections.abc import Sequence

from simconsole.profiles.scenario import EventStep, RemoteStep
from simconsole.values.signals import NEVER_TICKS, NO_COMMAND, Event, EventInput, RemoteCommand, RemoteKind
from simconsole.values.units import RAD_PER_DEG


class ScriptedCommands:
    """Plays `RemoteStep`s and `EventStep`s; a command repeats every period and ages in between, as over a network."""

    def __init__(self, remote: Sequence[RemoteStep], events: Sequence[EventStep], tick_hz: int) -> None:
        self._steps = sorted(remote, key=lambda step: step.start_s)
        self._events = [(round(step.at_s * tick_hz), Event[step.event.upper()]) for step in events]
        self._tick_hz = tick_hz
        self._sequence = 0
        self._received_tick: int | None = None
        self._command = NO_COMMAND

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the command in force at `tick`, its age, and this tick's edges."""
        for step in self._steps:
            start, end = round(step.start_s * self._tick_hz), round(step.end_s * self._tick_hz)
            period = max(1, step.period_ms * self._tick_hz // 1000)
            if start <= tick < end and (tick - start) % period == 0:
                self._sequence += 1
                self._received_tick = tick
                self._command = _command(step, self._sequence)
        age = NEVER_TICKS if self._received_tick is None else float(tick - self._received_tick)
        mask = 0
        for at, event in self._events:
            if at == tick:
                mask |= int(event)
        return self._command._replace(age_ticks=age), EventInput(events=float(mask))


def _command(step: RemoteStep, sequence: int) -> RemoteCommand:
    return NO_COMMAND._replace(
        kind=float(RemoteKind[step.kind.upper()]),
        sequence=float(sequence),
        road_wheel_rad=step.road_wheel_deg * RAD_PER_DEG,
        accel_mps2=step.accel_mps2,
        speed_mps=step.speed_mps,
        yaw_rate_radps=step.yaw_rate_radps,
        throttle=step.throttle,
        brake=step.brake,
        x_m=step.x_m,
        y_m=step.y_m,
        direction=float(step.direction),
        turn_indicators=float(step.turn_indicators),
        hazard_lights=float(step.hazard_lights),
    )
