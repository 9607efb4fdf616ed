"""A session with tokens, TLS only, or other names of topics is driven by its own autopilot all the same."""

import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from simconsole.cli.certificate import make, write_private
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.session.autopilot_program import TOKEN_VARIABLE
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Mode

TOKEN = "own-token-that-nobody-else-has"
LIMIT_S = 7


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The words of each program that is started, without an inherited token."""
    words: list[list[str]] = []
    real = subprocess.Popen

    def popen(given: list[str], *arguments: Any, **options: Any) -> Any:
        words.append(given)
        return real(given, *arguments, **options)

    monkeypatch.setattr(subprocess, "Popen", popen)
    monkeypatch.delenv(TOKEN_VARIABLE, raising=False)
    return words


@pytest.fixture
def files(tmp_path: Path) -> Callable[..., dict[str, Any]]:
    """The keys of a bridge section, with files behind them."""

    def written(*kinds: str, tokens: str = f"view {'v' * 20}\ncontrol {TOKEN}\n") -> dict[str, Any]:
        pair = make("127.0.0.1")
        (tmp_path / "b.pem").write_bytes(pair.certificate)
        write_private(tmp_path / "b.key", pair.key)
        write_private(tmp_path / "tokens", tokens.encode())
        names = {"certificate": "b.pem", "certificate_key": "b.key", "tokens": "tokens"}
        return {key: str(tmp_path / name) for key, name in names.items() if key.split("_")[0] in kinds}

    return written


NAMES = {"namespace": "/ego", "rename": {"/odom": "/localization/kinematic_state"}}


@pytest.mark.parametrize(
    ("kinds", "names"), [(("tokens",), {}), (("certificate",), {}), (("tokens", "certificate"), {}), ((), NAMES)]
)
def test_own_autopilot_drives(
    kinds: tuple[str, ...],
    names: dict[str, Any],
    files: Callable[..., dict[str, Any]],
    started: list[list[str]],
    tmp_path: Path,
) -> None:
    session = override(
        load_session("demo"),
        outputs={"bridge": {"port": 0, **names, **files(*kinds)}, "hud": None, "scene": None, "report": False},
        scenario={"duration_s": LIMIT_S},
    )
    session = override(session, devices={"person": {"sit_s": 0.5, "cruise_kmh": 20, "autonomy": {"distance_m": 5}}})
    result = drive(resolve(session), tmp_path / "bundle")
    assert result.summary["unanswered"] == 0
    assert result.summary["exchanges"] > 0
    assert result.summary["bridge"]["refused"] == 0
    table = open_bundle(tmp_path / "bundle").log.table(("arbitration.mode",))
    assert table.column("arbitration.mode")[-1] == Mode.AUTONOMOUS
    assert TOKEN not in " ".join(word for words in started for word in words)
    for path in (tmp_path / "bundle").rglob("*"):
        assert path.is_dir() or TOKEN.encode() not in path.read_bytes(), path


def test_tokens_without_control_are_refused_at_the_start(
    files: Callable[..., dict[str, Any]], started: list[list[str]], tmp_path: Path
) -> None:
    bridge = {"port": 0, **files("tokens", tokens=f"view {'v' * 20}\n")}
    session = override(load_session("demo"), outputs={"bridge": bridge, "report": False})
    with pytest.raises(ProfileError, match=r"outputs\.bridge\.tokens: .*tokens: no token of role control"):
        drive(resolve(session), tmp_path / "bundle")
    assert started == []
