"""One contract for every motor: none, simulated, watched, and SDL's and evdev's behind a mocked kernel."""

import json
from collections.abc import Callable, Iterator
from functools import cache

import pytest

from simconsole.devices.force_feedback.motor import HapticPort, NoHaptics, SimulatedWheelPort
from simconsole.devices.force_feedback.simulated_wheel import SimulatedWheel
from simconsole.devices.haptics.watchdog_client import Watchdog, WatchdogPort
from simconsole.profiles.force_feedback import ForceFeedback
from tests.devices.mocked import start
from tests.devices.port_contract import CHECKS
from tests.paths import ROOT
from tests.patience import PATIENCE_S

Judge = Callable[[str], str]
"""Takes the name of a check and returns what is wrong, empty where it holds."""


def simulated() -> HapticPort:
    return SimulatedWheelPort(SimulatedWheel(ForceFeedback(max_torque_nm=4.0), 1080.0, tick_hz=250))


def _here(port: HapticPort) -> Judge:
    def judge(name: str) -> str:
        try:
            CHECKS[name](port)
        except AssertionError as error:
            return str(error) or name
        return ""

    return judge


@pytest.fixture(scope="class")
def mocked(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], dict[str, str]]:
    """Run every check of a back end in one program behind the mocked kernel."""

    @cache
    def outcome(back_end: str) -> dict[str, str]:
        program = start(tmp_path_factory.mktemp(back_end) / "calls.jsonl", "contract", back_end)
        out, err = program.communicate(timeout=PATIENCE_S)
        assert program.returncode == 0, out + err
        judged: dict[str, str] = json.loads(out.splitlines()[-1])
        return judged

    return outcome


@pytest.fixture
def watchdog() -> Iterator[Watchdog]:
    opened = Watchdog((0xFFFF, 0xFFFF))
    yield opened
    opened.close()


@pytest.fixture(params=["none", "simulated", "watched", "sdl", "evdev"])
def judge(request: pytest.FixtureRequest) -> Judge:
    if request.param in ("sdl", "evdev"):
        judged = request.getfixturevalue("mocked")(request.param)
        return lambda name: str(judged[name])
    if request.param == "watched":
        return _here(WatchdogPort(simulated(), request.getfixturevalue("watchdog")))
    return _here(NoHaptics() if request.param == "none" else simulated())


@pytest.mark.parametrize("check", list(CHECKS))
class TestEveryMotor:
    """The contract."""

    def test_keeps(self, check: str, judge: Judge) -> None:
        assert judge(check) == ""


def test_a_motor_that_breaks_the_contract_is_found() -> None:
    class Stubborn(SimulatedWheelPort):
        def close(self) -> None:
            """Keep pushing."""

    stubborn = Stubborn(SimulatedWheel(ForceFeedback(max_torque_nm=4.0), 1080.0, tick_hz=250))
    assert _here(stubborn)("closes_twice_and_then_has_no_force") != ""


def test_every_port_of_the_package_is_under_the_contract() -> None:
    package = ROOT / "simconsole" / "devices"
    ports = {path.stem for path in package.rglob("*.py") if "A `HapticPort`." in path.read_text("utf-8")}
    assert ports == {"evdev_haptics", "sdl_haptics", "watchdog_client"}, "a new one belongs into `judge`"
