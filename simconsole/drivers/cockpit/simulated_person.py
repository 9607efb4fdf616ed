"""The simulated person at virtual devices: sees the last tick, and acts through joysticks only."""

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.force_feedback.simulated_wheel import RELAXED, STEERING, SimulatedWheel
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.drivers.simulated_person.behaviour import PersonBehaviour
from simconsole.drivers.simulated_person.guidance import Guidance
from simconsole.drivers.simulated_person.situation import Look, ahead_in
from simconsole.drivers.simulated_person.view import view_of
from simconsole.profiles.person import PersonPlan
from simconsole.values.state_vector import Snapshot


class SimulatedPerson:
    """A `Seat`: `act` once per tick, before the devices are polled."""

    def __init__(
        self,
        plan: PersonPlan,
        cockpit: VirtualCockpit,
        settings: CockpitSettings,
        *,
        tick_hz: int,
        wheel: SimulatedWheel | None = None,
        guidance: Guidance | None = None,
        look: Look = ahead_in,
    ) -> None:
        """Put the person at the devices.

        Args:
            plan: What to do.
            cockpit: The virtual devices to work.
            settings: The cockpit's, as `calibrate` gets them: a person knows their own pedals.
            tick_hz: The session's tick rate.
            wheel: The wheel between the hands and the axis, with its motor; None: the axis is where the hands are.
            guidance: Where to drive and how fast; None: straight on.
            look: What of other road users and signals there is to see in a tick.
        """
        self._wheel = wheel
        self.person = PersonBehaviour(plan, tick_hz, guidance)
        self._look = look
        self._cockpit = cockpit
        self._settings = settings
        self._written: tuple[Intent, int] | None = None

    @property
    def finished(self) -> bool:
        """Whether the plan is carried out."""
        return self.person.finished

    def act(self, snapshot: Snapshot) -> None:
        """Look at the last tick and move wheel, pedals, lever and buttons.

        Raises:
            DeviceError: SDL refuses.
        """
        intent = self.person.decide(view_of(snapshot, self._look(snapshot)))
        if self._wheel is not None:
            intent = intent._replace(hand_wheel_rad=self._turn(self._wheel, intent.hand_wheel_rad))
        now = (intent, self._cockpit.plugged)
        if now != self._written:
            self._cockpit.write(raw_sample(now[0], self._settings))
            self._written = now

    def _turn(self, wheel: SimulatedWheel, hands_rad: float) -> float:
        """Advance the wheel by a tick: resting hands go along with it, steering hands pull it to where they want it."""
        if not self.person.rests_hands:
            return wheel.turn(STEERING, hands_rad)
        angle_rad = wheel.turn(RELAXED)
        self.person.carry_hands(angle_rad)
        return angle_rad
