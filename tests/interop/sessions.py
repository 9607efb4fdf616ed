"""A session in which whoever answers the odometry drives, as fast as it goes."""

from pathlib import Path

SESSION = """
schema: 1
title: Driven from outside
scenario:
  vehicle: hatchback
  duration_s: {seconds}
features:
  control:
    person_required: false
outputs:
  bridge:
    port: {port}
    ros2: {ros2}
    record: [/odom]
  hud: null
  scene: null
  report: false
devices:
  driver: none
mode:
  pacing: lockstep
  answer_timeout_s: 60
"""


def lockstep_session(folder: Path, port: int, seconds: int, ros2: bool = False) -> str:
    """Write the session's profile; return its path."""
    path = folder / "session.yaml"
    path.write_text(SESSION.format(port=port, seconds=seconds, ros2="{}" if ros2 else "null"))
    return str(path)
