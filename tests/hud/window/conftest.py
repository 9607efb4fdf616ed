"""A display that nobody sees, for windows of pygame."""

from collections.abc import Iterator

import pygame
import pytest


@pytest.fixture
def dummy_display(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Give pygame no display for a test, and close what it opened."""
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    yield
    pygame.display.quit()
