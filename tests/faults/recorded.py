"""A short drive to record, and what a drive that did not end leaves."""

from pathlib import Path
from typing import Any

from simconsole.profiles.session import SessionProfile
from simconsole.session.resolution import load_session, override, resolve
from simconsole.tick.assembly import ResolvedSession
from tests.manifests import forge

SECONDS = 2.0
HZ = 250
TICKS = round(SECONDS * HZ)


def session(script: Path, seconds: float = SECONDS) -> ResolvedSession:
    """A person who drives off, as fast as it goes."""
    plain: SessionProfile = override(
        load_session("seated"),
        scenario={"duration_s": seconds},
        devices={"driver": f"script:{script}"},
        outputs={"hud": None, "scene": None, "report": False, "bridge": None},
        mode={"pacing": "free"},
    )
    return resolve(plain)


def unfinish(folder: Path, **changes: object) -> None:
    """Leave what a drive that did not end leaves."""

    def change(manifest: dict[str, Any]) -> None:
        for key in ("ticks", "digest", "summary"):
            del manifest[key]
        del manifest["files"]["drive.log"]
        manifest.update(finished=False, **changes)

    forge(folder, change)
