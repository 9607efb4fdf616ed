"""SDL's joystick half, started once per process and stopped when its last user releases it."""

import os
from typing import Any, Final

from simconsole.values.errors import DeviceError

_ENVIRONMENT: Final = {
    "SDL_VIDEODRIVER": "dummy",  # this process shows no window; the driver's view has its own process
    "SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS": "1",  # without it input is dead as long as no window has the focus
    "SDL_NO_SIGNAL_HANDLERS": "1",  # SIGINT and SIGTERM belong to the session
    "PYGAME_HIDE_SUPPORT_PROMPT": "1",  # standard output belongs to --json
}


class _Runtime:
    """Number of SDL's users, and what this module itself started."""

    users = 0
    started_display = False
    set_here: tuple[str, ...] = ()


def acquire() -> Any:
    """Start SDL's joysticks and return the pygame module. Every call needs one `release`.

    Missing environment variables are set, existing ones kept, before SDL starts: it reads them then. The last `release`
    takes them back: a window in another process, started later, must not inherit them.

    Raises:
        DeviceError: pygame is missing or SDL refuses.
    """
    _Runtime.set_here += tuple(name for name in _ENVIRONMENT if name not in os.environ)
    for name in _Runtime.set_here:
        os.environ[name] = _ENVIRONMENT[name]
    try:
        import pygame
    except ImportError as error:
        raise DeviceError(f"pygame-ce: module: {error}: an installed pygame-ce") from error
    if _Runtime.users == 0:
        try:
            _Runtime.started_display = not pygame.display.get_init()
            pygame.display.init()  # the event queue needs it
            pygame.joystick.init()
        except pygame.error as error:
            raise DeviceError(f"SDL: joysticks: {error}: a working SDL") from error
        # State is read, not events: without these the queue holds nothing but arrivals, removals and presses.
        pygame.event.set_blocked((pygame.JOYAXISMOTION, pygame.JOYHATMOTION, pygame.JOYBUTTONUP))
    _Runtime.users += 1
    return pygame


def release() -> None:
    """Release SDL; the last user's call stops what the first one's started."""
    if _Runtime.users == 0:
        return
    _Runtime.users -= 1
    if _Runtime.users:
        return
    for name in _Runtime.set_here:
        os.environ.pop(name, None)
    _Runtime.set_here = ()
    import pygame

    pygame.event.set_allowed((pygame.JOYAXISMOTION, pygame.JOYHATMOTION, pygame.JOYBUTTONUP))
    pygame.event.clear()
    pygame.joystick.quit()
    if _Runtime.started_display:
        pygame.display.quit()
