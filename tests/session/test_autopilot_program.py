import pytest

from simconsole.processes.lifetimes import DRIVE_VARIABLE, close_pipe, end
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.session import Features, Scenario, SessionProfile
from simconsole.session.autopilot_program import TOKEN_VARIABLE, start_autopilot
from tests.patience import PATIENCE_S

SESSION = SessionProfile(
    schema=1,
    scenario=Scenario(vehicle="light_van"),
    features=Features(autopilot="urban", tracker="stanley"),
)


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
    drives = ["--course", "urban", "--tracker", "stanley", "--vehicle", "light_van"]
    assert words[4:] == ["--url", "wss://127.0.0.1:9", *drives, *names, "--certificate", "b.pem"]
    assert environment[TOKEN_VARIABLE] == "secret"
    assert {"secret", "nonce"}.isdisjoint(words)
    assert environment[DRIVE_VARIABLE] == without[DRIVE_VARIABLE] == "nonce"
    assert plain[4:] == ["--url", "ws://[::1]:9", *drives]
    assert TOKEN_VARIABLE not in without
