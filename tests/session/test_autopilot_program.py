import pytest
from msgspec.structs import replace

from simconsole.cli.main import parser
from simconsole.processes.lifetimes import DRIVE_VARIABLE, close_pipe, end
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.control import ControlProfile
from simconsole.profiles.link import LONGEST_MS, LinkProfile, WayProfile
from simconsole.profiles.session import Features, Scenario, SessionProfile
from simconsole.session.autopilot_program import TOKEN_VARIABLE, start_autopilot
from tests.patience import PATIENCE_S

SESSION = SessionProfile(
    schema=1,
    scenario=Scenario(vehicle="light_van"),
    features=Features(autopilot="urban", tracker="stanley", control=ControlProfile(automatic_lateral_jerk_mps3=3.5)),
)

GATE = ["--lateral-accel", "5", "--lateral-jerk", "3.5"]


def test_an_autopilot_whose_console_is_gone_ends_by_itself() -> None:
    program = start_autopilot("ws://127.0.0.1:9", SESSION, BridgeProfile(), "0" * 32, None)
    assert program.poll() is None
    close_pipe(program)
    assert program.wait(PATIENCE_S) == 1, "not by giving up a server that is not there (2)"


def test_an_autopilot_with_nobody_to_drive_for_is_ended() -> None:
    program = start_autopilot("ws://127.0.0.1:9", SESSION, BridgeProfile(), "0" * 32, None)
    end([program], 60.0)
    assert program.returncode == 1


def test_a_token_goes_by_the_environment_and_a_server_on_all_addresses_is_reached_here(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    started: list[tuple[list[str], dict[str, str]]] = []

    def spawn(words: list[str], environment: dict[str, str]) -> None:
        started.append((words, environment))

    monkeypatch.setattr("simconsole.session.autopilot_program.spawn", spawn)
    monkeypatch.delenv(TOKEN_VARIABLE, raising=False)
    named = BridgeProfile(certificate="b.pem", namespace="/ego", rename={"/odom": "/here"})
    start_autopilot("wss://0.0.0.0:9", SESSION, named, "nonce", "secret")
    start_autopilot("ws://[::]:9", SESSION, BridgeProfile(), "nonce", None)
    (words, environment), (plain, without) = started
    names = ["--namespace", "/ego", "--rename", "/odom=/here"]
    drives = ["--course", "urban", "--tracker", "stanley", "--vehicle", "light_van", *GATE]
    assert words[4:] == ["--url", "wss://127.0.0.1:9", *drives, *names, "--certificate", "b.pem"]
    assert environment[TOKEN_VARIABLE] == "secret"
    assert {"secret", "nonce"}.isdisjoint(words)
    assert environment[DRIVE_VARIABLE] == without[DRIVE_VARIABLE] == "nonce"
    assert plain[4:] == ["--url", "ws://[::1]:9", *drives], "in lockstep it is asked for no plan"
    assert TOKEN_VARIABLE not in without


def test_it_is_told_of_the_whole_way_there_and_back_however_long(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[list[str]] = []
    monkeypatch.setattr("simconsole.session.autopilot_program.spawn", lambda words, environment: started.append(words))
    slow = WayProfile(delay_ms=LONGEST_MS, jitter_ms=LONGEST_MS)
    for link in (
        LinkProfile(delay_ms=30.0, jitter_ms=10.0, measurements=WayProfile(delay_ms=5.0, jitter_ms=20.0)),
        LinkProfile(delay_ms=LONGEST_MS, jitter_ms=LONGEST_MS, measurements=slow),
    ):
        start_autopilot("ws://127.0.0.1:9", SESSION, BridgeProfile(link=link), "nonce", None)
    start_autopilot("ws://127.0.0.1:9", SESSION, BridgeProfile(), "nonce", None, plan_hz=5.0)
    given = [parser().parse_args(words[2:]) for words in started]
    assert [one.plan_hz for one in given] == [0.0, 0.0, 5.0]
    told = [one.delay_ms for one in given[:2]]
    assert told == [50.0, 3.0 * LONGEST_MS]


def test_it_follows_advice_where_the_session_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[list[str]] = []
    monkeypatch.setattr("simconsole.session.autopilot_program.spawn", lambda words, environment: started.append(words))
    advised = replace(SESSION, features=replace(SESSION.features, speed_advice=True))
    for session in (SESSION, advised):
        start_autopilot("ws://127.0.0.1:9", session, BridgeProfile(), "nonce", None)
    assert [parser().parse_args(words[2:]).speed_advice for words in started] == [False, True]
