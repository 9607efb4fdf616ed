"""Trials of a cockpit: what is wrong with it is found, by virtual devices that do not do what they should."""

from contextlib import ExitStack

import msgspec
import pytest

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.devices.setup.cockpit_trials import Trials
from simconsole.devices.setup.device_commands import unpaced
from simconsole.profiles.device import CockpitProfile

pytestmark = pytest.mark.usefixtures("sdl")


def quiet(line: str) -> None:
    return


def test_good_cockpit_passes_each_trial(t500: CockpitProfile) -> None:
    with ExitStack() as stack:
        trials = Trials(t500, True, unpaced, quiet, stack)
        verdicts = [trials.rest(), *(trials.pedal(name) for name in trials.pedals), trials.wheel(), trials.gears()]
        verdicts += [trials.buttons(), trials.latency(), trials.hot_plug()]
        assert all(verdict.ok for verdict in verdicts), verdicts


def test_what_is_wrong_is_named(t500: CockpitProfile, monkeypatch: pytest.MonkeyPatch) -> None:
    pedals = msgspec.structs.replace(t500.pedals, clutch=t500.pedals.throttle)
    with ExitStack() as stack:
        trials = Trials(msgspec.structs.replace(t500, pedals=pedals), True, unpaced, quiet, stack)
        assert trials.pedal("clutch").how == "moved throttle, too"
    with ExitStack() as stack:
        trials = Trials(t500, True, unpaced, quiet, stack)
        trials.rest()
        watch = trials.watch
        monkeypatch.setattr(trials, "watch", lambda text, seconds, hands: watch(text, seconds, lambda t: Intent()))
        assert trials.gears().how.startswith("missing: [1, 2")
        assert not trials.buttons().ok
        assert not trials.wheel().ok
        assert trials.latency().how == "the wheel did not turn"
