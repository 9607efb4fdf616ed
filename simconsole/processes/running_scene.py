"""Where a running drive's scene is: how a process of nobody's drive, a viewer's, finds it."""

from pathlib import Path
from typing import Final, NamedTuple

from simconsole.processes.shared_memory import run_folders
from simconsole.values.errors import WorkerError
from simconsole.values.host.files import write_atomically

SCENE_PATH: Final = "scene.path"


class RunningScene(NamedTuple):
    """The scene of a drive that goes on."""

    folder: Path
    """The drive's run folder: it is gone once the drive has ended."""
    path: Path
    """The file that the scene is appended to."""

    @property
    def goes_on(self) -> bool:
        """Whether the drive goes on."""
        return (self.folder / SCENE_PATH).exists()


def name_scene(folder: Path, path: Path) -> None:
    """Leave in a run folder where the drive's scene is."""
    write_atomically(folder / SCENE_PATH, str(path).encode(), durable=False)


def running_scenes() -> list[RunningScene]:
    """Return the scenes of all drives of this user that go on, the newest last."""
    found: list[tuple[float, RunningScene]] = []
    for folder in run_folders():
        try:
            path = (folder / SCENE_PATH).read_text("utf-8")
            found.append(((folder / SCENE_PATH).stat().st_mtime, RunningScene(folder, Path(path))))
        except (OSError, UnicodeDecodeError):
            continue  # it keeps no scene, or has just ended
    return [scene for _, scene in sorted(found, key=lambda item: item[0])]


def scene_of(bundle: Path) -> RunningScene | None:
    """Return the scene of the drive that goes on into a bundle, None where none does."""
    found = [scene for scene in running_scenes() if scene.path.parent == bundle.absolute()]
    return found[-1] if found else None


def newest_scene() -> RunningScene:
    """Return the scene of the drive that was started last.

    Raises:
        WorkerError: no drive goes on that keeps one.
    """
    scenes = running_scenes()
    if not scenes:
        raise WorkerError(
            "no drive with a scene goes on here: one does that is paced (mode.pacing realtime) and has outputs.scene; "
            "to see a drive that has ended: simconsole view BUNDLE"
        )
    return scenes[-1]
