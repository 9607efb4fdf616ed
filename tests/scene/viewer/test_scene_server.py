"""rerun's own server shows a running drive to real clients: late ones, several, and ones that do not read."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from simconsole.scene.viewer.scene_server import HOST, SceneServer, open_native
from simconsole.values.errors import WorkerError
from tests.paths import ROOT
from tests.patience import wait_until
from tests.ports import free_port
from tests.scene.viewer.test_export import exported, rerun_rrd
from tests.scene.viewer.viewers import listening_hosts, live_scene, viewer

TWO_MINUTES_S = 130
PATH, ROAD, MODE = "/world/path/driven", "/world/road/surface", "/lanes/mode"
LOOPBACK = "0100007F"


def pieces(path: Path, entity: str) -> int:
    """How many pieces of an entity a file holds."""
    return rerun_rrd("print", str(path)).stdout.count(f" - {entity} - ")


@contextmanager
def serving(path: Path) -> Iterator[SceneServer]:
    server = SceneServer(path)
    try:
        yield server
    finally:
        server.close()


def fed(server: SceneServer, condition: Callable[[], bool]) -> Callable[[], bool]:
    def look() -> bool:
        server.pump()
        return condition()

    return look


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scene of more than two minutes."""
    path = tmp_path_factory.mktemp("drive") / "scene.live.rrd"
    live_scene(path, TWO_MINUTES_S, ROOT)
    return path


def test_late_viewers_see_map_and_whole_path_and_then_what_comes(tmp_path: Path, drive: Path) -> None:
    path = tmp_path / "scene.live.rrd"
    path.write_bytes(drive.read_bytes())
    driven, modes = pieces(path, PATH), pieces(path, MODE)
    assert driven > 50
    with serving(path) as server, viewer(server.addresses.native, tmp_path / "first.rrd") as first:
        wait_until(fed(server, lambda: first.sees(PATH) == driven), "the whole path")
        with viewer(server.addresses.native, tmp_path / "second.rrd") as second:
            wait_until(fed(server, lambda: second.sees(PATH) == driven), "the whole path, for another")
            for one in (first, second):
                assert one.sees(ROAD) == 1
                assert one.sees(MODE) == modes
            live_scene(path, 5, ROOT)  # the drive goes on
            more = pieces(path, PATH)
            assert more > driven
            wait_until(fed(server, lambda: first.sees(PATH) == second.sees(PATH) == more), "what comes, for both")


def test_a_viewer_that_does_not_read_keeps_nothing_from_the_others(tmp_path: Path, drive: Path) -> None:
    path = tmp_path / "scene.live.rrd"
    path.write_bytes(drive.read_bytes())
    driven = pieces(path, PATH)
    with serving(path) as server, viewer(server.addresses.native, tmp_path / "frozen.rrd") as frozen:
        wait_until(fed(server, lambda: frozen.sees(PATH) == driven), "a viewer")
        os.kill(frozen.process.pid, signal.SIGSTOP)
        with viewer(server.addresses.native, tmp_path / "other.rrd") as other:
            live_scene(path, 2 * TWO_MINUTES_S, ROOT)
            more = pieces(path, PATH)
            wait_until(fed(server, lambda: other.sees(PATH) == more), "all of it, for the other")
        os.kill(frozen.process.pid, signal.SIGCONT)


def test_it_listens_on_this_machine_only(drive: Path) -> None:
    with serving(drive) as server:
        told = {
            f":{part.partition('/')[0].partition('?')[0]}"
            for part in (server.addresses.native.split(":")[-1], server.addresses.browser.split(":")[2])
        }

        def listened() -> set[str]:
            """The ports that it listens on; the page's comes a moment after the other."""
            return {f":{port}" for port in listening_hosts(server.process_id)}

        wait_until(lambda: listened() >= told, "both ports")
        assert listened() == told
        assert set().union(*listening_hosts(server.process_id).values()) == {LOOPBACK}
        assert server.addresses.native.startswith(f"rerun+http://{HOST}:")


KILLED = """
import os, signal, sys
from pathlib import Path
from simconsole.scene.viewer.scene_server import SceneServer
server = SceneServer(Path(sys.argv[1]))
print(server.process_id, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the kernel of Linux does it")
def test_the_server_ends_with_who_feeds_it_however_that_ended(drive: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", KILLED, str(drive)], capture_output=True, text=True, check=False, cwd=ROOT
    )
    assert done.returncode == -9, done.stderr
    number = int(done.stdout)
    wait_until(lambda: not Path(f"/proc/{number}").exists(), "the server's end")


def test_a_server_that_has_ended_is_told(drive: Path) -> None:
    with serving(drive) as server:
        os.kill(server.process_id, signal.SIGKILL)
        wait_until(lambda: not server.runs, "its end")
        server._at = 0
        with pytest.raises(WorkerError, match="server has ended"):
            server.pump()


def test_a_port_that_is_taken_is_one_line(drive: Path) -> None:
    from simconsole.scene.viewer.scene_server import Ports

    with serving(drive) as server:
        port = int(server.addresses.native.split(":")[-1].partition("/")[0])
        with pytest.raises(WorkerError, match=f"ports .*{port}.* taken"):
            SceneServer(drive, Ports(grpc=port, web=free_port()))


def test_a_window_of_its_own_listens_on_this_machine_only_and_says_only_what_is_wrong(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[tuple[list[str], dict[str, str]]] = []

    def popen(words: list[str], **given: Any) -> None:
        started.append((words, given["env"]))

    monkeypatch.setattr("simconsole.scene.viewer.scene_server.subprocess.Popen", popen)
    open_native(str(tmp_path / "scene.rrd"))
    ((words, environment),) = started
    assert words[1:] == ["--bind", HOST, "--port", "auto", str(tmp_path / "scene.rrd")]
    assert environment["RUST_LOG"] == "error"


def test_a_scene_that_is_whole_is_served_too(tmp_path: Path) -> None:
    path = tmp_path / "scene.rrd"
    assert exported(tmp_path, path, "car", 3000) == ""
    with serving(path) as server, viewer(server.addresses.native, tmp_path / "one.rrd") as one:
        wait_until(fed(server, lambda: one.sees(PATH) == pieces(path, PATH)), "the whole path")
        assert one.sees(ROAD) == 1
