"""A drive ends where its vehicle strikes something and nobody has modelled what that does to it."""

import json
from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.tick.assembly import assemble
from simconsole.tick.collision_end import CollisionEnd
from simconsole.values.host.jit import compiled
from simconsole.values.state_vector import LAYOUT, Snapshot
from tests.world.nets import STRAIGHT

WALL = '<additional><poly id="w" type="building" shape="12,-9 20,-9 20,9 12,9"/></additional>'
SCRIPT = """schema: 1
points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.6, gear: 1}
  - {time_s: 0.8, throttle: 0.6}
"""


def test_the_first_collision_ends_it_and_is_the_reason() -> None:
    console, state = assemble(resolve(load_session("roll_a_ball")), compiled)
    end = CollisionEnd(console.platform)
    assert end.outputs == (end,)
    end.publish(Snapshot(7, console.tick_hz, state.vector))
    assert (end.ended(), end.summary()) == (False, {})
    struck = state.vector.copy()
    struck[LAYOUT.rules.at("collision")] = 1.0
    for tick in (8, 9):
        end.publish(Snapshot(tick, console.tick_hz, struck))
    assert end.ended()
    assert end.summary() == {"ended": "collision at tick 8: a ball cannot be pushed"}


def test_a_car_is_pushed_and_drives_on() -> None:
    assert CollisionEnd(assemble(resolve(load_session("demo")), compiled)[0].platform).outputs == ()


@pytest.mark.parametrize("traffic", ["", ", traffic: {vehicles: 0, lead: {gap_m: 8, speeds: [{speed_kmh: 0}]}}"])
def test_a_ball_that_rolls_against_something_ends_its_drive(tmp_path: Path, traffic: str) -> None:
    (tmp_path / "map.net.xml").write_text(STRAIGHT)
    (tmp_path / "map.poly.xml").write_text(WALL)
    (tmp_path / "script.yaml").write_text(SCRIPT)
    (tmp_path / "world.yaml").write_text(
        "schema: 1\nkind: roads\ntitle: one road\nmap: {name: map.net.xml}\npolygons: {name: map.poly.xml}\n"
        "route: {by: edges, edges: [AB, BC]}\n"
    )
    (tmp_path / "session.yaml").write_text(
        f"schema: 1\nenvironment: {{world: world.yaml{traffic}}}\nscenario: {{vehicle: ball, duration_s: 60}}\n"
        f"devices: {{driver: 'script:{tmp_path / 'script.yaml'}'}}\nmode: {{pacing: free}}\n"
        "outputs: {hud: null, scene: null, report: false, bridge: null}\n"
    )
    resolved = override(load_session(str(tmp_path / "session.yaml")))
    result = drive(resolve(resolved), tmp_path / "bundle")
    log = open_bundle(result.folder).log
    touched, x_m = (log.table((name,)).column(name) for name in ("rules.collision", "vehicle.x_m"))
    first = int(np.flatnonzero(touched)[0]) + 1
    assert result.summary["ended"] == f"collision at tick {first}: a ball cannot be pushed"
    assert 5.0 < x_m[first - 1] < 12.0
    assert result.ticks < 60 * 250, "it comes to rest, and that is the end"
    assert json.loads((result.folder / "manifest.json").read_text())["summary"]["ended"] == result.summary["ended"]
    assert replay_bundle(result.folder).hashes_equal
