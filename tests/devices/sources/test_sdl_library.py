"""pygame's own SDL, by its path: what is mapped on Linux, what the wheels of pygame-ce hold elsewhere."""

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from simconsole.devices.sources import sdl_library, sdl_runtime
from simconsole.devices.sources.sdl_library import joystick_path, loaded_sdl
from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec
from simconsole.values.errors import DeviceError


def test_it_is_the_one_that_is_loaded() -> None:
    sdl_runtime.acquire()
    try:
        assert Path(loaded_sdl()).name.startswith("libSDL2-2")
        assert loaded_sdl() in Path("/proc/self/maps").read_text()
    finally:
        sdl_runtime.release()


@pytest.mark.parametrize(("platform", "file"), [("win32", "SDL2.dll"), ("darwin", ".dylibs/libSDL2-2.0.0.dylib")])
def test_elsewhere_it_lies_in_pygames_folder(
    platform: str, file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The files of pygame_ce-2.5.8-cp311-cp311-win_amd64.whl and ...-macosx_10_11_universal2.whl."""
    monkeypatch.setitem(sys.modules, "pygame", SimpleNamespace(__file__=str(tmp_path / "__init__.py")))
    monkeypatch.setattr(sdl_library, "sys", SimpleNamespace(platform=platform))
    (tmp_path / ".dylibs").mkdir()
    for other in ("SDL2_image.dll", ".dylibs/libSDL2_mixer-2.0.0.800.2.dylib"):
        (tmp_path / other).touch()
    with pytest.raises(DeviceError, match="SDL: library: value not found: a pygame-ce that carries SDL 2"):
        loaded_sdl()
    (tmp_path / file).touch()
    assert loaded_sdl() == str(tmp_path / file)


def test_virtual_joysticks_and_none_at_all_have_no_path() -> None:
    device = VirtualDevice(VirtualSpec("Pad", 0x1234, 0x5678, 2, 3))
    try:
        assert joystick_path(device.instance_id) == ""
        assert joystick_path(999) == ""
    finally:
        device.close()
