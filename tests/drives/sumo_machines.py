"""Three machines: SUMO, the console and the autopilot, each in a network namespace of its own, with slow links.

Run by `unshare --map-root-user --net`, in whose namespace the console is: python -m tests.drives.sumo_machines FOLDER
MS... It writes FOLDER/lockstep-MS and FOLDER/seated, bundles of drives over links that are late by so many ms each way.
"""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Final

from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.world.sumo_traffic.engines import sumo_program
from tests.bridge.networks import Chaos
from tests.drives.console import words
from tests.patience import wait_until
from tests.world.sumo_traffic.on_sumo import configuration

SEATED_MS: Final = 100
PORT, BRIDGE_PORT = 8813, 9090
_LISTENS = "0A"
_FLOW: Final = '<flow id="f" begin="0" end="60" period="2" departSpeed="10"><route edges="road0 road1 road2"/></flow>'
_SESSION: Final = """\
schema: 1
environment:
  world: urban_signals
  traffic: {sumo: {backend: traci, address: "ADDRESS", warm_up_s: 0.2, radius_m: 1000, timeout_s: 60}}
scenario: {vehicle: ball, start: {x_m: 100}}
features: {autopilot: null}
devices: {driver: "none"}
"""
_LOCKSTEP: Final = f"""\
outputs:
  hud: null
  scene: null
  report: false
  bridge: {{host: 0.0.0.0, port: {BRIDGE_PORT}, allowed_hosts: [10.9.2.1], trust_network: true}}
mode: {{pacing: lockstep, answer_timeout_s: 60}}
"""
_SEATED: Final = """\
outputs: {hud: null, scene: null, report: false, bridge: null}
mode: {pacing: realtime}
"""


class Machine:
    """A network namespace with one cable to the console's: 10.9.NUMBER.1 is the console's end."""

    def __init__(self, number: int, stack: ExitStack) -> None:
        hold = ["unshare", "--net", "sh", "-c", "ip link set lo up; echo; exec cat"]
        self._holder = stack.enter_context(subprocess.Popen(hold, stdin=subprocess.PIPE, stdout=subprocess.PIPE))
        assert self._holder.stdout is not None
        self._holder.stdout.readline()
        self.console, self.address = f"10.9.{number}.1", f"10.9.{number}.2"
        here, namespace = f"cable{number}", str(self._holder.pid)
        _ip("link", "add", here, "type", "veth", "peer", "name", "card", "netns", namespace)
        _ip("addr", "add", f"{self.console}/24", "dev", here)
        _ip("link", "set", here, "up")
        subprocess.run(self._inside("ip", "addr", "add", f"{self.address}/24", "dev", "card"), check=True)
        subprocess.run(self._inside("ip", "link", "set", "card", "up"), check=True)

    @contextmanager
    def runs(self, *program: str) -> Iterator["subprocess.Popen[bytes]"]:
        """A program on this machine; it ends here at the latest."""
        with subprocess.Popen(self._inside(*program), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
            try:
                yield running
            finally:
                running.kill()

    def _inside(self, *program: str) -> list[str]:
        return ["nsenter", f"--net=/proc/{self._holder.pid}/ns/net", *program]


def _ip(*given: str) -> None:
    subprocess.run(["ip", *given], check=True)


@contextmanager
def late(host: str, port: int, delay_ms: int) -> Iterator[tuple[str, int]]:
    """Where to connect to get there over a link that is late by so much each way."""
    if not delay_ms:
        yield host, port
        return
    chaos = Chaos(port, 0.001 * delay_ms, host=host)
    try:
        yield "", chaos.port
    finally:
        chaos.stop()


@contextmanager
def sumo_on(machine: Machine, config: str) -> Iterator[None]:
    """SUMO, as docs/traffic.md says that it is to be started elsewhere; it ends with its one client."""
    program = sumo_program()
    assert program is not None
    options = ["--remote-port", str(PORT), "--step-length", "0.04", "--seed", "1", "--collision.action", "warn"]
    with machine.runs(program, "-c", config, *options) as sumo:
        listens = f":{PORT:04X} 00000000:0000 {_LISTENS} "
        wait_until(lambda: listens in Path(f"/proc/{sumo.pid}/net/tcp").read_text(), "SUMO listens")
        yield


def driven(folder: Path, sumo: Machine, delay_ms: int, more: str, duration_s: float) -> None:
    with sumo_on(sumo, str(folder.parent / "own.sumocfg")), late(sumo.address, PORT, delay_ms) as (host, port):
        text = _SESSION.replace("ADDRESS", f"{host or '127.0.0.1'}:{port}")
        text = text.replace("{vehicle: ball,", f"{{vehicle: ball, duration_s: {duration_s},")
        folder.with_suffix(".yaml").write_text(text + more)
        drive(resolve(load_session(str(folder.with_suffix(".yaml")))), folder)


def main() -> None:
    folder, delays_ms = Path(sys.argv[1]), [int(delay_ms) for delay_ms in sys.argv[2:]]
    configuration(folder, _FLOW)
    _ip("link", "set", "lo", "up")
    with ExitStack() as stack:
        sumo, remote = Machine(1, stack), Machine(2, stack)
        for delay_ms in delays_ms:
            with late("127.0.0.1" if delay_ms else remote.console, BRIDGE_PORT, delay_ms) as (host, port):
                url = f"ws://{host or remote.console}:{port}"
                autopilot = words("autopilot", "--url", url, "--course", "urban_signals", "--wait", "600")
                with remote.runs(*autopilot):
                    driven(folder / f"lockstep-{delay_ms}", sumo, delay_ms, _LOCKSTEP, 0.3)
        driven(folder / "seated", sumo, SEATED_MS, _SEATED, 5.0)


if __name__ == "__main__":
    main()
