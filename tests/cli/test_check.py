from pathlib import Path

from tests.drives.console import complaint, simconsole


def test_a_file_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    done = simconsole("check", "launch_and_stop", "--junit", tmp_path / "nowhere" / "junit.xml")
    assert "No such file or directory" in complaint(done)
