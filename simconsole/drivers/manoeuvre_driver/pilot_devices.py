"""The test driver's cockpit: a pilot's hands and feet as raw axes. Pure."""

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.drivers.manoeuvre_driver.run_up import Pilot
from simconsole.values.signals import DeviceSample
from simconsole.values.state_vector import Snapshot


class PilotDevices:
    """A `Seat` and a `DeviceSource` in one (values/protocols.py): `act` sees a tick, `poll` answers it."""

    def __init__(self, pilot: Pilot, settings: CockpitSettings) -> None:
        self._pilot = pilot
        self._settings = settings
        self._intent = Intent()
        self.finished = False

    def act(self, snapshot: Snapshot) -> None:
        """Ask the pilot what to do in the coming tick."""
        intent = self._pilot(snapshot)
        if intent is None:
            self.finished = True
        else:
            self._intent = intent

    def poll(self, tick: int) -> DeviceSample:
        """Return what the axes read, age 0."""
        return raw_sample(self._intent, self._settings)

    def close(self) -> None:
        """Nothing to release."""
