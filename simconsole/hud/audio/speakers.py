"""Loudspeakers through SDL's mixer: one block sounds while the next one waits."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final, Protocol

import numpy as np

from simconsole.hud.sound.directions import CHANNELS, Samples, to_stereo
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.profiles.view import SoundProfile
from simconsole.values.errors import WorkerError

SDL_SAMPLES: Final = 256
"""Of SDL's own buffer: it adds 5 ms to what waits."""
FULL: Final = 32_767.0


class Loudspeakers(Protocol):
    """Where blocks of sound go."""

    starved: int
    """How often there was nothing to play."""

    def wants(self) -> bool:
        """Return whether there is room for a block."""

    def play(self, block: Samples) -> None:
        """Take one, float32 [samples, 6]."""


class Speakers:
    """A sound device with two or six loudspeakers."""

    def __init__(self, profile: SoundProfile) -> None:
        """Open the device.

        Raises:
            WorkerError: there is none, or none of this name.
        """
        pygame = _library()
        self.starved = 0
        self._begun = False
        try:
            self._open(profile.device, profile.speakers, pygame.AUDIO_ALLOW_CHANNELS_CHANGE)
            if _columns() not in (2, CHANNELS):
                pygame.mixer.quit()
                self._open(profile.device, 2, 0)
        except pygame.error as problem:
            named = "" if profile.device is None else f" {profile.device!r}"
            raise WorkerError(f"sound: no device{named}: {problem}") from None
        self.channels = _columns()
        pygame.mixer.set_num_channels(1)
        self._channel = pygame.mixer.Channel(0)

    @staticmethod
    def _open(device: str | None, channels: int, allowed: int) -> None:
        import pygame

        with _quiet():
            pygame.mixer.init(RATE_HZ, -16, channels, SDL_SAMPLES, devicename=device, allowedchanges=allowed)

    def wants(self) -> bool:
        """Return whether there is room for a block."""
        return self._channel.get_queue() is None

    def play(self, block: Samples) -> None:
        """Take a block, float32 [samples, 6] within -1 and 1."""
        import pygame

        columns = block if self.channels == CHANNELS else np.clip(to_stereo(block), -1.0, 1.0)
        sound = pygame.mixer.Sound(buffer=np.ascontiguousarray(FULL * columns, "<i2").tobytes())
        if self._channel.get_busy():
            self._channel.queue(sound)
            return
        self.starved += self._begun
        self._begun = True
        self._channel.play(sound)

    def close(self) -> None:
        """Close the device; what waits is not played."""
        import pygame

        pygame.mixer.quit()


def _library() -> Any:
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # standard output belongs to --json
    import pygame

    return pygame


@contextmanager
def _quiet() -> Iterator[None]:
    """Leave out what sound libraries write to standard error about devices that are not there: the error says it."""
    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)


def _columns() -> int:
    import pygame

    opened = pygame.mixer.get_init()
    return 0 if opened is None else opened[2]


def device_names() -> list[str]:
    """Return what sound devices there are, by name."""
    pygame = _library()
    from pygame._sdl2 import audio

    try:
        with _quiet():
            pygame.mixer.init()
        return list(audio.get_audio_device_names(False))
    except pygame.error:
        return []
    finally:
        pygame.mixer.quit()
