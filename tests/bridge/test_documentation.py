"""docs/rosbridge.md says what the code does: its tables and its examples."""

import itertools
import queue
import re
import threading
from collections.abc import Callable
from typing import Any

from simconsole.bridge.console.command_decoder import REQUESTS, CommandDecoder
from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.input_slots import BridgeInputs
from simconsole.bridge.console.plan_input import AdviceInput, PlanInput
from simconsole.bridge.console.published_tick import ONCE, OutputTopic
from simconsole.bridge.console.road_user_topics import RoadUserTopics
from simconsole.bridge.console.topics import Outputs
from simconsole.bridge.messages import standard_registry
from simconsole.bridge.protocol.operations import OPERATIONS
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.files.loader import parse
from simconsole.profiles.session import Outputs as OutputsSection
from simconsole.values.signals import RemoteKind
from simconsole.world.earth import earth_of
from simconsole.world.traffic.road_users import NOBODY, RoadUsersAt
from simconsole.world.world import ShownMap
from tests.paths import ROOT
from tests.patience import PATIENCE_S

PAGE = (ROOT / "docs" / "rosbridge.md").read_text()


def rows(heading: str) -> list[list[str]]:
    section = PAGE.split(f"## {heading}\n")[1].split("\n## ")[0]
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in section.splitlines() if line.startswith("| `")]


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)


def test_output_table() -> None:
    def rate(row: OutputTopic) -> str:
        if row.watched is not None:
            return f"{row.rate_hz:g}, latched, and with each change"
        return "once, latched" if row.rate_hz == ONCE else f"{row.rate_hz:g}"

    others = RoadUserTopics(standard_registry(), lambda: RoadUsersAt(0, NOBODY)).topics()
    topics = (*others, *Outputs(standard_registry(), BridgeProfile(), shown_map=ShownMap(earth=earth_of())).topics())
    assert rows("What the console publishes") == [[f"`{row.name}`", row.type, rate(row)] for row in topics]


def test_command_table() -> None:
    for told in (PlanInput(BridgeProfile(), None).topic(), AdviceInput(None).topic()):
        assert f"`{told.name}` ({told.type})" in PAGE
    topics = CommandDecoder(BridgeInputs(), BridgeProfile()).topics()
    listed = {(name, kind) for name, kind, _ in rows("What commands the console")}
    assert listed == {(f"`{row.name}`", row.type) for row in topics}
    assert all(f"`{word}`" in PAGE for word in (*REQUESTS, *OPERATIONS))


def test_controller_in_fourteen_lines_drives(serving: Callable[..., Any], snapshot: Callable[..., Any]) -> None:
    server = serving(rates_hz={"/odom": 250.0})
    example = blocks("python")[0].replace("ws://127.0.0.1:9090", server.url).replace("timeout_s=5.0", "timeout_s=0.3")
    assert len(example.strip().splitlines()) <= 14
    program = threading.Thread(target=exec, args=(example, {}))
    program.start()
    command = None
    for tick in itertools.count(1):
        server.snapshots.put(snapshot(tick, y_m=2.0))
        try:
            command, _ = server.commands.get(timeout=0.02)
            break
        except queue.Empty:
            assert tick < 1000
    program.join(timeout=PATIENCE_S)
    assert command is not None
    assert (command.kind, command.speed_mps, command.yaw_rate_radps) == (RemoteKind.TWIST, 5.0, -0.4)


def test_own_message_type() -> None:
    namespace: dict[str, Any] = {}
    exec(blocks("python")[1], namespace)
    assert namespace["message"].force_n == [1.5]


def test_session_section() -> None:
    texts = [text.replace("outputs:\n", "") for text in blocks("yaml")]
    profile, joined, recorded = (parse(text, OutputsSection, "docs/rosbridge.md").bridge for text in texts)
    assert profile is not None
    assert joined is not None
    assert joined.upstream is not None
    assert recorded is not None
    assert joined.upstream.url == "ws://robot:9090"
    assert (recorded.messages, recorded.record) == ("messages", ("/odom", "/grip*"))
    names = ConsoleBridge(profile).names
    assert (names["/odom"], names["/cmd_vel"]) == ("/localization/kinematic_state", "/ego/cmd_vel")
    assert profile.rates_hz["/tf"] == 0.0
