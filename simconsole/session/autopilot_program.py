"""The session's own autopilot: a program beside the drive, and what it needs to be let in by its bridge."""

import os
import secrets
import subprocess
from collections.abc import Sequence

from simconsole.bridge.transport.addresses import reached_here
from simconsole.processes.lifetimes import ATTACHED, DRIVE_VARIABLE, spawn
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.link import late_ms
from simconsole.profiles.session import SessionProfile
from simconsole.values.errors import BridgeError

TOKEN_VARIABLE = "SIMCONSOLE_TOKEN"
"""Environment variable with the token that commands show to the server they connect to."""
PROGRAM_END_S = 0.3
"""How long a program that the drive has started may take to close its connection; it has nothing else to finish."""


def new_nonce() -> str:
    """Return a nonce that identifies this drive to the programs that it starts."""
    return secrets.token_hex(16)


def own_token(session: SessionProfile) -> str | None:
    """Return the token with which the session's own programs connect to its bridge; None where none is needed."""
    features = session.features
    if session.outputs.bridge is None or not (features.autopilot is not None or features.speed_advice):
        return None
    from simconsole.bridge.transport.credentials import control_token

    return control_token(session.outputs.bridge)


def start_autopilot(
    url: str,
    session: SessionProfile,
    bridge: BridgeProfile,
    drive: str,
    token: str | None,
    plan_hz: float = 0.0,
    namespaces: Sequence[str] = (),
) -> "subprocess.Popen[bytes]":
    """Start `simconsole autopilot` as a program of its own, which ends with this process.

    Args:
        url: the console's own server.
        session: what to follow, how, in which car, and what its gate lets pass.
        bridge: what its topics are called, its certificate, and how late its commands act.
        drive: the drive's nonce, without which the program would take the next drive at this address for this one.
        plan_hz: how often a second it is to tell what it plans; 0: never.
        namespaces: of cars that are alike and that it drives all; without, there is one, in that of `bridge`.
        token: what the server asks for; both go by the environment, for everyone can read a program's arguments.

    Raises:
        BridgeError: it cannot be started.
    """
    control = session.features.control
    arguments = [
        "-m",
        "simconsole",
        "autopilot",
        ATTACHED,
        "--url",
        reached_here(url),
        "--course",
        session.features.autopilot or "",
        "--tracker",
        session.features.tracker,
        "--vehicle",
        session.scenario.vehicle,
        "--lateral-accel",
        f"{control.automatic_lateral_accel_mps2:g}",
        "--lateral-jerk",
        f"{control.automatic_lateral_jerk_mps3:g}",
    ]
    if delay_ms := late_ms(bridge.link):
        arguments += ["--delay-ms", f"{delay_ms:g}"]
    if plan_hz:
        arguments += ["--plan-hz", f"{plan_hz:g}"]
    if session.features.speed_advice:
        arguments += ["--speed-advice"]
    for namespace in namespaces or filter(None, (bridge.namespace,)):
        arguments += ["--namespace", namespace]
    for standard, name in bridge.rename.items():
        arguments += ["--rename", f"{standard}={name}"]
    if bridge.certificate is not None:
        arguments += ["--certificate", bridge.certificate]
    shown = {DRIVE_VARIABLE: drive} if token is None else {DRIVE_VARIABLE: drive, TOKEN_VARIABLE: token}
    try:
        return spawn(arguments, environment={**os.environ, **shown})
    except OSError as error:
        raise BridgeError(f"the autopilot cannot be started: {error.strerror}") from None
