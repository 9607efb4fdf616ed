"""Tests that need a real wheel are opted into: not collected, so not left out, without the flag."""

import re
import subprocess
import sys

from tests.paths import ROOT


def collected(*words: str) -> tuple[int, str]:
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider", *words]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


def test_without_the_flag_none_is_collected_and_with_it_all_of_the_list() -> None:
    code, text = collected("tests/hardware")
    assert (code, "test_h" in text) == (5, False), text
    code, text = collected("tests/hardware", "--hardware", "t500rs_th8rs")
    assert code == 0, text
    tested = {name.upper() for name in re.findall(r"test_(h\d\d)_", text)}
    assert tested == set(re.findall(r"^\| (H\d\d) ", (ROOT / "docs" / "hardware.md").read_text(), re.MULTILINE))


def test_machine_without_the_devices_fails_it_instead_of_leaving_it_out() -> None:
    command = [sys.executable, "-m", "pytest", "-q", "tests/hardware", "--hardware", "t500rs_th8rs", "-k", "h03"]
    done = subprocess.run([*command, "-p", "no:cacheprovider"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "not connected" in done.stdout
