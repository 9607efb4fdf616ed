"""Small sweeps: a car that is started by a script and rolls, which takes a tenth of a second of processor time."""

from pathlib import Path
from typing import Any

import yaml

from simconsole.evaluation.sweep.plan import Plan, load_plan

SESSION = {
    "schema": 1,
    "environment": {"world": "urban"},
    "scenario": {"vehicle": "hatchback"},
    "outputs": {"bridge": None, "hud": None, "scene": None, "sound": None, "report": False},
    "devices": {"driver": "script:script.yaml"},
    "mode": {"pacing": "free", "tick_hz": 100},
}
SCRIPT = {
    "points": [
        {"time_s": 0.0, "throttle": 0.0, "brake": 0.0, "clutch": 0.0, "hand_wheel_deg": 0.0, "gear": 0},
        {"time_s": 0.5, "clutch": 1.0},
        {"time_s": 1.0, "gear": 1, "throttle": 0.4, "clutch": 1.0},
        {"time_s": 3.0, "clutch": 0.0, "hand_wheel_deg": 0.0},
        {"time_s": 60.0, "hand_wheel_deg": 90.0, "throttle": 0.4},
    ],
}


def write_plan(folder: Path, **changes: Any) -> Path:
    """Write a plan, its session and its script; the plan's file."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "script.yaml").write_text(yaml.safe_dump(SCRIPT))
    (folder / "session.yaml").write_text(yaml.safe_dump(SESSION))
    plan = {"schema": 1, "title": "grip", "sessions": ["session.yaml"], "duration_s": 5.0, **changes}
    path = folder / "plan.yaml"
    path.write_text(yaml.safe_dump(plan, sort_keys=False))
    return path


def grip(folder: Path, count: int = 4, **changes: Any) -> Plan:
    """A plan of `count` drives at different friction."""
    values = {"environment.friction": {"from": 0.2, "to": 1.0, "count": count}}
    return load_plan(write_plan(folder, values=values, **changes))
