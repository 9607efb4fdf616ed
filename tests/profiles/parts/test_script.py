from pathlib import Path

import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.values.errors import ProfileError


def test_script_whose_time_goes_back_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "script.yaml"
    path.write_text("points:\n- {time_s: 1.0, throttle: 0}\n- {time_s: 0.5, throttle: 1}\n")
    with pytest.raises(ProfileError, match=r"points\[1\].time_s 0.5 must be above 1.0"):
        load("devices", str(path), ScriptProfile)
