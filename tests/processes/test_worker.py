"""A worker's configuration arrives in its process as it was, and what does not fit is one line."""

import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from simconsole.processes.worker import Worker, WorkerCall, WorkerSpec, load_worker
from simconsole.profiles.can import CanProfile
from simconsole.session.resolution import load_session, resolve
from simconsole.session.scene_worker import SceneWorker, scene_source
from simconsole.session.worker_programs import CanWorker
from simconsole.values.errors import WorkerError

CAN = CanWorker(profile=CanProfile(), tick_hz=500, wheels=(7, 8, 9, 10), bundle="/tmp/bundle")


@pytest.fixture(scope="module")
def scene() -> SceneWorker:
    source = scene_source(resolve(load_session("demo")), ("vehicle.x_m",), 250)
    return SceneWorker(path="/tmp/scene.rrd", source=source, has_bridge=True)


def test_a_worker_is_the_same_on_the_other_side(scene: SceneWorker) -> None:
    for worker in (scene, CAN, msgspec.structs.replace(CAN, wheels=None)):
        told = msgspec.json.encode(WorkerSpec.of("any", worker))
        assert load_worker(msgspec.json.decode(told, type=WorkerSpec)) == worker


@pytest.mark.parametrize(
    ("target", "configuration", "why"),
    [
        ("simconsole.nowhere:Any", "{}", "No module named 'simconsole.nowhere'"),
        ("simconsole.session.worker_programs:Nothing", "{}", "has no attribute 'Nothing'"),
        ("simconsole.session.scene_worker:SceneWorker", '{"path": "s.rrd"}', "missing required field `source`"),
    ],
)
def test_what_does_not_fit_is_named(target: str, configuration: str, why: str) -> None:
    spec = WorkerSpec(name="any", target=target, configuration=msgspec.Raw(configuration.encode()))
    with pytest.raises(WorkerError, match=f"^worker any: {target} cannot be loaded: .*{why}"):
        load_worker(spec)


def test_only_a_worker_is_run() -> None:
    with pytest.raises(WorkerError, match=r"^worker any: builtins:int is not a worker$"):
        load_worker(WorkerSpec(name="any", target="builtins:int", configuration=msgspec.Raw(b"3")))


def test_a_worker_says_what_it_does_itself() -> None:
    with pytest.raises(NotImplementedError):
        Worker().run(Path(), lambda: True)


WITHOUT_FILES = """
import ctypes, resource, sys
ctypes.CDLL("libgcc_s.so.1")  # glibc opens it when a thread ends, and aborts if it may not
from pathlib import Path
from simconsole.processes import worker
def fail(*_):
    resource.setrlimit(resource.RLIMIT_NOFILE, (3, 3))
    Path("/dev/null").open()
worker.load_worker = fail
sys.exit(worker.main())
"""


def test_a_worker_that_may_open_no_more_files_is_one_line(tmp_path: Path, scene: SceneWorker) -> None:
    call = WorkerCall(folder=str(tmp_path), worker=WorkerSpec.of("scene", scene), patience_s=1.0)
    command = [sys.executable, "-c", WITHOUT_FILES]
    done = subprocess.run(
        command, input=msgspec.json.encode(call).decode() + "\n", capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert done.stderr == "simconsole worker: OSError: [Errno 24] Too many open files: '/dev/null'\n"
