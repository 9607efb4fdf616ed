"""Kernels: functions of one source text that run as plain Python and compiled, with equal bits.

A kernel takes and returns floats, `typing.NamedTuple`s of floats and float64 arrays, calls only other kernels
(imported by name), `math.sqrt` and `abs`, and uses only + - * / and comparisons. It stays an ordinary function
here; `simconsole.values.host.jit` makes the compiled twin, so importing a core never loads numba.
"""

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, TypeVar

from numpy.typing import NDArray

F = TypeVar("F", bound=Callable[..., Any])

Row = NDArray[Any]
"""A float64 vector."""


def kernel(function: F) -> F:
    """Mark `function` as a kernel and return it unchanged."""
    function.__kernel__ = True  # type: ignore[attr-defined]
    return function


def stage(function: F) -> F:
    """Mark `function` as a kernel that is compiled once, by itself; kernels that call it share that machine code.

    Other kernels are compiled into each one that calls them: faster where little is done in a call, but long to
    compile where much is.
    """
    function.__stage__ = True  # type: ignore[attr-defined]
    return kernel(function)


def is_kernel(value: object) -> bool:
    """Return whether `value` was marked by `kernel` or `stage`."""
    return bool(getattr(value, "__kernel__", False))


def is_stage(value: object) -> bool:
    """Return whether `value` was marked by `stage`."""
    return bool(getattr(value, "__stage__", False))


def holding(call: Callable[..., Any], held: tuple[Any, ...] | None) -> Callable[..., Any]:
    """Return `call`, a kernel or its compiled twin, with its first argument handed over for good.

    Each array that Python hands to compiled code takes its time at every call, whatever is done with it: those that
    stay the same from call to call are taken apart once.

    Args:
        call: what an execution makes of a kernel.
        held: a `typing.NamedTuple` of arrays, numbers, and such tuples, or None; its arrays must stay where they are.
    """
    hold: Callable[..., Callable[..., Any]] | None = getattr(call, "hold", None)
    return partial(call, held) if hold is None else hold(held)


def forget() -> None:
    """Do nothing; compiled code reads arrays again from here on instead of keeping what it has read.

    Numbers that are needed only much later are better read again there: there are some thirty registers, and what does
    not fit into them is spilled to the stack.
    """


def foreseen() -> None:
    """Do nothing; a branch that begins with this stays a jump in compiled code.

    Of a short branch the compiler rather computes both ways and chooses: what follows waits for both and for the
    condition. Where a branch mostly goes the way that it went in the step before, a processor foresees the jump and
    goes on without waiting for anything.
    """


@kernel
def put(row: Row, start: int, values: Iterable[float]) -> None:
    """Write a NamedTuple of floats into `row` from `start`."""
    index = start
    for value in values:
        row[index] = value
        index += 1


@kernel
def clip(value: float, low: float, high: float) -> float:
    """Limit a *finite* value, `low` at most `high`. Test `is_finite` first: a NaN would pass every comparison."""
    if value < low:  # two separate tests, no `elif`: they compile to two instructions, a maximum and a minimum
        value = low
    if value > high:
        value = high
    return value


@kernel
def steady_clip(value: float, low: float, high: float) -> float:
    """Return the same as `clip`, sooner for a value that stays within its limits, or at one of them, for many steps."""
    if value < low:
        foreseen()
        value = low
    if value > high:
        foreseen()
        value = high
    return value


@kernel
def is_finite(value: float) -> bool:
    """Return False for NaN and both infinities, by arithmetic alone (equal in both executions)."""
    return value - value == 0.0


@kernel
def approach(value: float, target: float, step: float) -> float:
    """Move `value` towards `target` by at most `step` (>= 0): a rate limit over one tick."""
    return clip(target, value - step, value + step)
