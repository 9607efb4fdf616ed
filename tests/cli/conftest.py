from pathlib import Path

import pytest

from tests.recording.conftest import rewrite_checksums, rewrite_log, rewrite_session

__all__ = ["rewrite_checksums", "rewrite_log", "rewrite_session"]


@pytest.fixture
def plain(tmp_path: Path) -> Path:
    """A session that makes a bundle and nothing beside it."""
    path = tmp_path / "plain.yaml"
    path.write_text("schema: 1\noutputs: {hud: null, scene: null, report: false}\nmode: {pacing: free}\n")
    return path
