"""How late the core's ticks are in a paced drive on SUMO, in its worker, and in one without traffic.

Run: python benchmarks/sumo_lateness.py [--seconds S] [--rounds N] [--vehicles N]

Paced drives of the urban course with signals, in turns, without any other worker. Lateness is that of all ticks of a
drive, as its manifest has it (bins of 12 %); told are the means of the rounds' medians, and their ratio.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Final

_SESSION: Final = """\
schema: 1
environment: {{world: urban_signals, traffic: {traffic}}}
scenario: {{vehicle: hatchback}}
outputs: {{bridge: null, hud: null, scene: null, report: false}}
devices: {{driver: virtual, person: {{sit_s: 0.5, along: route, seed: 1}}}}
mode: {{pacing: realtime, tick_hz: 250}}
"""


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--vehicles", type=int, default=60)
    given = parser.parse_args()
    on_sumo = f"{{seed: 1, sumo: {{vehicles: {given.vehicles}, radius_m: 1000}}}}"
    kinds = {"without": "null", "on SUMO": on_sumo}
    found: dict[str, list[dict[str, Any]]] = {name: [] for name in kinds}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(given.rounds):
            for name, traffic in kinds.items():
                found[name].append(_drive(Path(folder) / f"{number} {name}", traffic, given.seconds))
    for name, drives in found.items():
        medians = [one["lateness_us"]["p50"] for one in drives]
        latest = [one["lateness_us"]["p99"] for one in drives]
        print(
            f"  {name:8s}: median {statistics.fmean(medians):6.1f} us ({min(medians):.0f} to {max(medians):.0f}),"
            f" p99 {statistics.fmean(latest):7.1f} us"
        )
    without, beside = (statistics.fmean(one["lateness_us"]["p50"] for one in drives) for drives in found.values())
    lost = sum("lost" in one["traffic"] for one in found["on SUMO"])
    print(f"  ratio of the medians {beside / without:.2f}; drives in which SUMO was lost: {lost}")


def _drive(folder: Path, traffic: str, seconds: float) -> dict[str, Any]:
    """Drive once; return the summary of its manifest."""
    folder.mkdir()
    session = folder / "session.yaml"
    session.write_text(_SESSION.format(traffic=traffic))
    words = ["drive", str(session), "--for", f"{seconds:g}", "--out", str(folder / "bundle"), "--no-pack"]
    subprocess.run([sys.executable, "-m", "simconsole", *words], check=True, capture_output=True)
    summary: dict[str, Any] = json.loads((folder / "bundle" / "manifest.json").read_bytes())["summary"]
    return summary


if __name__ == "__main__":
    main()
