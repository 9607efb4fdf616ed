"""Advice from a real drive's topics: what its worker hears, shows and leaves in the log."""

from itertools import pairwise
from pathlib import Path

import msgspec
import pytest

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.table import recorded_drive
from simconsole.evaluation.report.page import page
from simconsole.processes.byte_slot import ByteSlot
from simconsole.processes.worker import WorkerSpec, load_worker
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.log_header import ADVICE
from simconsole.session.advice.advice_worker import (
    ADVICE_BYTES,
    OLD_S,
    AdviceSource,
    AdviceWorker,
    NewestAdvice,
    ToldAdvice,
    hears_advice,
)
from simconsole.session.lifecycle import drive
from simconsole.session.preconditions import check_session
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.errors import ProfileError
from simconsole.values.units import tick_time_ns
from simconsole.world.rules.speed_advice import NO_ADVICE, STOP, Advice, Advised, from_bytes, to_bytes
from tests.paths import ROOT

BAND = Advice(Advised.SPEED, 8.0, 11.0, 10.5)
SESSION = """\
schema: 1
environment: {world: world.yaml}
scenario: {vehicle: hatchback, duration_s: 27, start: {x_m: 320}}
features: {speed_advice: true}
outputs: {hud: null, scene: null, report: false, bridge: BRIDGE}
devices:
  driver: virtual
  person: {title: drives, sit_s: 0.3, along: route, seed: 1}
mode: {pacing: realtime, tick_hz: 100}
"""


GREEN_S = 22
"""The light on the way, 139 m ahead, is red until then; at the limit the car would be there 8 s before."""


def session(folder: Path, bridge: str = "{port: 0}") -> Path:
    shipped = ROOT / "profiles" / "worlds" / "urban_signals"
    net, world = shipped.with_suffix(".net.xml").read_text(), shipped.with_suffix(".yaml").read_text()
    (folder / "urban_signals.net.xml").write_text(net.replace('offset="0"', f'offset="{GREEN_S}"'))
    (folder / "world.yaml").write_text(world)
    path = folder / "session.yaml"
    path.write_text(SESSION.replace("BRIDGE", bridge))
    return path


def test_a_person_is_advised_by_topics_and_drives_so_and_the_report_tells_what_that_brought(tmp_path: Path) -> None:
    result = drive(resolve(load_session(str(session(tmp_path)))), tmp_path / "bundle")
    bundle = open_bundle(result.folder)
    told = [(message.tick, from_bytes(message.content)) for message in bundle.log.messages(ADVICE)]
    assert any(advice.kind is not Advised.NOTHING for _, advice in told)
    assert all(before != after for (_, before), (_, after) in pairwise(told))
    limit_mps = bundle.log.table().column("situation.speed_limit_mps").max()
    assert all(5.0 <= one.low_mps <= one.target_mps <= limit_mps for _, one in told if one.kind is Advised.SPEED)
    assert result.summary["worker_restarts"] == {"bridge": 0, "advice": 0}
    assert replay_bundle(result.folder).hashes_equal
    found = metrics(recorded_drive(bundle.log), None)
    advice = found["speed_advice"]
    assert advice["lights"] == advice["advised"] == advice["followed"]["lights"] == 1
    assert advice["compliance"] > 0.8
    assert (advice["followed"]["stops"], advice["followed"]["waiting_s"]) == (0.0, 0.0)
    assert advice["followed"]["time_loss_s"] > 5.0, "it came no earlier than the green"
    assert not bundle.log.table().column("rules.red_light").any()
    html = page("t", found, (), {}, {})
    assert "Advised before 1 of 1 lights" in html
    assert f"{100.0 * advice['compliance']:.0f} % of the time" in html


def test_advice_without_topics_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match=r"features\.speed_advice: value true: needs outputs\.bridge"):
        check_session(load_session(str(session(tmp_path, "null"))))


def test_advice_is_shown_until_it_is_old_and_logged_when_it_is_another(tmp_path: Path) -> None:
    slot = ByteSlot.create(tmp_path / ADVICE, ADVICE_BYTES)
    newest, source = NewestAdvice(tmp_path), AdviceSource(ByteSlot.open(tmp_path / ADVICE), 250)
    assert newest(0) == NO_ADVICE
    assert source.take_messages(1) == []
    slot.write(1_000_000_000, to_bytes(NO_ADVICE))
    assert source.take_messages(251) == []
    slot.write(2_000_000_000, to_bytes(BAND))
    assert newest(2_500_000_000) == BAND
    assert newest(2_000_000_001 + round(OLD_S * 1e9)) == NO_ADVICE
    assert source.take_messages(501) == [(ADVICE, to_bytes(BAND))]
    slot.write(2_100_000_000, to_bytes(BAND))
    assert source.take_messages(530) == []
    slot.write(2_200_000_000, to_bytes(STOP))
    assert source.take_messages(551) == [(ADVICE, to_bytes(STOP))]
    shown = [(tick, newest(tick_time_ns(tick, 250)) != NO_ADVICE) for tick in range(799, 803)]
    assert shown == [(799, True), (800, True), (801, False), (802, False)]
    assert [source.take_messages(tick) for tick, _ in shown] == [[], [], [(ADVICE, to_bytes(NO_ADVICE))], []]
    slot.write(3_300_000_000, to_bytes(STOP))
    assert source.take_messages(826) == [(ADVICE, to_bytes(STOP))]


def test_what_a_controller_says_is_logged_when_it_is_another() -> None:
    told = ToldAdvice()
    assert told.take_messages(1) == []
    told.take(to_bytes(STOP).decode())
    told.take(to_bytes(BAND).decode())
    assert told.take_messages(6) == [(ADVICE, to_bytes(BAND))]
    told.take(to_bytes(BAND).decode())
    assert told.take_messages(11) == []
    with pytest.raises(ValueError, match="7 is not a valid Advised"):
        told.take('{"kind": 7}')
    assert told.take_messages(16) == []


def test_advice_of_a_controller_is_kept_in_lockstep_only(tmp_path: Path) -> None:
    paced = load_session(str(session(tmp_path)))
    assert not hears_advice(paced)
    assert hears_advice(override(paced, mode={"pacing": "lockstep"}))
    assert not hears_advice(override(paced, mode={"pacing": "lockstep"}, features={"speed_advice": False}))


def test_a_bridge_that_was_started_again_is_looked_for_where_it_listens_now(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With port 0 that is another port; a client that came back by itself would ask at the first one for ever."""
    reached = list[str]()

    class Client(BridgeClient):
        def connect(self, patience_s: float = 0.0) -> None:
            reached.append(self.url)
            (tmp_path / "address").write_text(f"ws://127.0.0.1:{len(reached)}")
            self.disconnect()

    monkeypatch.setattr("simconsole.bridge.client.bridge_client.BridgeClient", Client)
    ByteSlot.create(tmp_path / ADVICE, ADVICE_BYTES)
    (tmp_path / "address").write_text("ws://127.0.0.1:9")
    worker = AdviceWorker(
        world=load_world("urban_signals"), vehicle=load_vehicle("hatchback"), drive="a", address="address"
    )
    worker.run(tmp_path, iter([False] * 40 + [True] * 9).__next__)
    assert reached[:3] == ["ws://127.0.0.1:9", "ws://127.0.0.1:1", "ws://127.0.0.1:2"]


def test_what_is_no_advice_is_refused() -> None:
    assert from_bytes(to_bytes(BAND)) == BAND
    for content in (b"[]", b"{}", b'{"kind": 7}', b'{"kind": 1, "fast": 2}'):
        with pytest.raises(ValueError, match=r"advice|not a valid"):
            from_bytes(content)


@pytest.mark.parametrize("vehicle", ["hatchback", "ball", "turtlebot3_burger"])
def test_its_configuration_travels_as_json(vehicle: str) -> None:
    worker = AdviceWorker(
        world=load_world("urban_signals"), vehicle=load_vehicle(vehicle), drive="a", address="b", rename={"/odom": "/o"}
    )
    assert load_worker(WorkerSpec.of("advice", worker)) == worker
    assert msgspec.json.encode(worker)
