"""Controllers of other packages: found by the entry points `simconsole.controllers`, named by `features.controller`.

Each stands where the bridge stands in lockstep, as `drivers/own_controller.py` has it, so a session, a scenario or a
sweep drives with it and needs no program beside.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Final, NamedTuple

from simconsole.drivers.own_controller import Controller
from simconsole.profiles.session import ControllerChoice
from simconsole.values.errors import ControllerError, one_line
from simconsole.values.platform import Platform
from simconsole.values.registered import Bounded, bounded_values, load, made
from simconsole.values.signals import RemoteCommand
from simconsole.values.state_vector import Snapshot
from simconsole.world.route import Route

GROUP: Final = "simconsole.controllers"
_KEY: Final = "features.controller"


class ControllerSettings(NamedTuple):
    """What a controller is made from, at the beginning of each drive."""

    parameters: Mapping[str, float]  # all of them, inside their bounds
    route: Route | None  # None: a world without one
    vehicle: Platform
    period_s: float  # between two of its answers


class OwnController(NamedTuple):
    """What an entry point names. `make` returns a new controller, which knows nothing of the drives before."""

    parameters: Mapping[str, Bounded]
    make: Callable[[ControllerSettings], Controller]


def named_controller(
    choice: ControllerChoice, route: Route | None, vehicle: Platform, period_s: float, own: OwnController | None = None
) -> Controller:
    """Return the controller that a session names, or `own`, for one drive. What it raises is one line that names it.

    Raises:
        ProfileError: there is none, a parameter is unknown or out of its bounds, or it cannot be made.
    """
    made_by = load(GROUP, choice.name, OwnController, f"{_KEY}.name") if own is None else own
    values = bounded_values(made_by.parameters, choice.parameters, f"{_KEY}.parameters")
    settings = ControllerSettings(values, route, vehicle, period_s)
    controller = made(lambda: made_by.make(settings), _flaws, f"{_KEY}: value {choice.name}")

    def call(seen: Snapshot) -> RemoteCommand | None:
        try:
            return _command(controller(seen))
        except Exception as error:  # whatever a stranger's function does
            raise ControllerError(f"controller {choice.name}: tick {seen.tick}: {one_line(error)}") from error

    return call


def _flaws(controller: Controller) -> Iterator[str]:
    if not callable(controller):
        yield f"{type(controller).__name__}: a function of a snapshot"


def _command(answer: RemoteCommand | None) -> RemoteCommand | None:
    if answer is not None and not isinstance(answer, RemoteCommand):
        raise TypeError(f"{type(answer).__name__}: a command, as of simconsole.hold_speed, or None")
    return answer
