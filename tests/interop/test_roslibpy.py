"""Stock roslibpy 2.1.0 from PyPI, on both its transports, subscribes and commands."""

import json
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.bridge.transport.server import serve
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from simconsole.values.signals import RemoteCommand, RemoteKind
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from tests.patience import PATIENCE_S, stamp_ns

PROGRAM = Path(__file__).with_name("roslibpy_program.py")
ANSWERS = 20


def snapshot(tick: int) -> Snapshot:
    row = np.zeros(PLATFORM_AT)
    row[LAYOUT.vehicle.start] = tick  # x_m
    return Snapshot(tick, 250, row)


@contextmanager
def program(port: int, transport: str) -> Iterator["subprocess.Popen[str]"]:
    environment = {**os.environ, "ROSLIBPY_TRANSPORT": transport}
    command = [sys.executable, "-W", "ignore", str(PROGRAM), str(port), str(ANSWERS)]
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def said(process: "subprocess.Popen[str]") -> dict[str, Any]:
    output, _ = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0
    return json.loads(output.splitlines()[-1])  # type: ignore[no-any-return]  # the program prints an object


EVERY_COMMAND = BridgeLimits(commands_hz=100_000.0)
"""On a busy machine answers come in bursts; how many a second are taken is tested elsewhere."""


@pytest.mark.parametrize("transport", ["twisted", "asyncio"])
def test_in_lockstep(transport: str) -> None:
    with LockstepBridge(BridgeProfile(port=0)) as bridge, program(bridge.port, transport) as process:
        assert bridge.wait_for_client(30.0)
        for number in range(1, ANSWERS + 1):
            assert bridge.exchange(snapshot(5 * number), 30.0)
            command, _ = bridge.take(5 * number + 1)
            assert command.sequence == number
            if number < ANSWERS:
                assert (command.kind, command.road_wheel_rad) == (RemoteKind.ACCELERATION, 5 * number / 1000)
                assert (command.accel_mps2, command.age_ticks) == (0.5, 0.0)
        assert (command.kind, command.speed_mps, command.yaw_rate_radps) == (RemoteKind.TWIST, 2.5, 0.25)
        while bridge.clients:
            bridge.publish(snapshot(5 * ANSWERS + 1))
        assert said(process) == {"finished": True, "positions": [5.0 * number for number in range(1, ANSWERS + 1)]}
        assert command.refused == 0.0


@pytest.mark.parametrize("transport", ["twisted", "asyncio"])
def test_against_the_server_of_its_own_process(transport: str) -> None:
    commands: list[RemoteCommand] = []
    ports: list[int] = []
    ready, stop = threading.Event(), threading.Event()
    began_ns = stamp_ns()
    last_tick = 0

    def newest() -> Snapshot | None:
        """A drive in real time at 250 Hz."""
        nonlocal last_tick
        tick = (stamp_ns() - began_ns) * 250 // 10**9
        if tick == last_tick:
            return None
        last_tick = tick
        return snapshot(tick)

    def listening(port: int) -> None:
        ports.append(port)
        ready.set()

    def run() -> None:
        serve(
            BridgeProfile(port=0, limits=EVERY_COMMAND),
            newest,
            lambda command, receipt_ns: commands.append(command),
            lambda events: None,
            stop.is_set,
            on_ready=listening,
        )

    thread = threading.Thread(target=run)
    thread.start()
    try:
        assert ready.wait(PATIENCE_S)
        with program(ports[0], transport) as process:
            report = said(process)
    finally:
        stop.set()
        thread.join(timeout=PATIENCE_S)
    assert report["finished"]
    positions = report["positions"]
    assert len(positions) >= ANSWERS
    assert positions == sorted(positions)
    answers = [command for command in commands if command.kind == RemoteKind.ACCELERATION]
    assert [command.road_wheel_rad for command in answers] == [x / 1000 for x in positions[: len(answers)]]
    assert commands[-1].kind == RemoteKind.TWIST
    assert (commands[-1].speed_mps, commands[-1].yaw_rate_radps, commands[-1].refused) == (2.5, 0.25, 0.0)
