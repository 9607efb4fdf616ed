"""`simconsole devices feel` on the kernel's interface, mocked: what a wheel is told, and never beyond its strength."""

from itertools import groupby, pairwise
from pathlib import Path

import msgspec

from simconsole.devices.setup.calibration_dialogue import write_profile
from simconsole.profiles.device import CockpitProfile
from tests.devices.mocked import calls, run_behind
from tests.patience import PATIENCE_S

FF_CONSTANT = 0x52
STEERING = 0x4000


def test_each_force_reaches_the_kernel_gently_and_ends(t500: CockpitProfile, tmp_path: Path) -> None:
    wheel, pedals, shifter = t500.roles
    same = {"vendor_id": wheel.vendor_id, "product_id": wheel.product_id}  # only the wheel stands behind the mock
    cockpit = tmp_path / "cockpit.yaml"
    roles = [wheel, pedals, msgspec.structs.replace(shifter, **same)]
    write_profile(cockpit, msgspec.structs.replace(t500, roles=roles))
    log = tmp_path / "calls.jsonl"
    words = ["-m", "simconsole", "devices", "feel", "--cockpit", str(cockpit), "--strength", "20"]
    done = run_behind(log, *words)
    out, err = done.communicate("\nl\n\nr\n\n" + 4 * "\ny\n", timeout=PATIENCE_S)
    assert done.returncode == 0, out + err
    assert out.index("sign:") < out.index("right:") < out.index("texture:"), "the sign first"
    told = calls(log)
    constant = [call for call in told if call["what"] == "upload" and call["type"] == FF_CONSTANT]
    levels = [call["level"] for call in constant]
    assert {call["direction"] for call in constant} == {STEERING}
    assert {call["length_ms"] for call in constant} == {200}
    assert max(map(abs, levels)) <= round(0.21 * 32767)
    pushes = [level for level in levels if abs(level) > 0.19 * 32767]
    assert [left for left, _ in groupby(level > 0 for level in pushes)][:2] == [True, False], "sign, right"
    assert sum(a * b < 0 for a, b in pairwise(levels)) > 10, "the texture shivers"
    assert {call["what"] for call in told[-4:]} >= {"gain", "autocentre", "end"}
    (slot,) = {call["id"] for call in constant}
    ended = [call for call in told if call["what"] == "remove" and call["id"] == slot]
    assert len(ended) == 1
