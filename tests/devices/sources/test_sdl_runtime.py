"""SDL is shared within the process: who starts and who stops it."""

import os

import pytest

from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec

PAD = VirtualSpec("Pad", 0x1234, 0x5678, 2, 3, 1)


def test_sdl_stops_with_its_last_user(sdl: None) -> None:
    pygame = sdl_runtime.acquire()
    pad = VirtualDevice(PAD)
    sdl_runtime.release()
    assert pygame.joystick.get_init()
    pad.close()
    assert not pygame.joystick.get_init()
    sdl_runtime.release()
    assert not pygame.display.get_init()


def test_display_of_someone_else_is_left_alone(sdl: None) -> None:
    pygame = sdl_runtime.acquire()
    sdl_runtime.release()
    pygame.display.init()
    sdl_runtime.acquire()
    sdl_runtime.release()
    assert pygame.display.get_init()
    pygame.display.quit()


def test_its_environment_is_not_left_to_programs_started_later(sdl: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
    monkeypatch.setenv("SDL_NO_SIGNAL_HANDLERS", "0")
    sdl_runtime.acquire()
    sdl_runtime.acquire()
    assert os.environ["SDL_VIDEODRIVER"] == "dummy"
    sdl_runtime.release()
    assert os.environ["SDL_VIDEODRIVER"] == "dummy"
    sdl_runtime.release()
    assert "SDL_VIDEODRIVER" not in os.environ
    assert os.environ["SDL_NO_SIGNAL_HANDLERS"] == "0"
