"""Compile kernels with numba: the fast twin of the plain functions.

Each kernel is copied with the kernels it calls replaced by their compiled twins. numba's own cache does not notice an
edited callee or constant in another file, so each twin is cached in a folder named by the digest of everything that
its machine code depends on: its code, its constants, and the same of every kernel it calls.
"""

import dis
import hashlib
import os
import shutil
import sys
import time
import types
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np

from simconsole.values.kernels import forget, is_kernel, take

F = TypeVar("F", bound=Callable[..., Any])

KEEP_UNUSED_S: Final = 30 * 24 * 3600.0
"""Compiled code that nobody has loaded for a month is removed when something new is compiled."""


def plain(function: F) -> F:
    """Return `function` itself: the execution without numba, bit-identical and about a hundred times slower."""
    return function


def compiled(function: F) -> F:
    """Return the compiled twin of a kernel. Compiles at its first call, or loads from the user's cache.

    Raises:
        TypeError: `function` is not a kernel, or uses something that the digest cannot see through.
    """
    return _entry(function)  # type: ignore[no-any-return]


def cache_folder() -> Path:
    """Return the folder of all compiled kernels of this user (`XDG_CACHE_HOME` is honoured)."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "simconsole" / "numba"


@cache
def digest(function: Callable[..., Any]) -> str:
    """Return 16 hex digits that change with anything that changes what `function` compiles to.

    Raises:
        TypeError: it uses a global that is neither a kernel nor a constant.
    """
    text = hashlib.sha256(f"{function.__module__}.{function.__qualname__}{sys.version}".encode())
    text.update(Path(__file__).read_bytes())
    text.update(repr(function.__defaults__).encode())
    text.update(repr([(name, _type_stamp(kind)) for name, kind in function.__annotations__.items()]).encode())
    for code in _codes(function.__code__):
        text.update(code.co_code)
        text.update(repr([c for c in code.co_consts if not isinstance(c, types.CodeType)]).encode())
        text.update(repr((code.co_names, code.co_varnames)).encode())
    for name in _global_names(function):
        text.update(f"{name}={_stamp(function.__globals__[name], function)};".encode())
    return text.hexdigest()[:16]


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _codes(constant)


def _global_names(function: Callable[..., Any]) -> list[str]:
    instructions = (step for code in _codes(function.__code__) for step in dis.get_instructions(code))
    used = {step.argval for step in instructions if step.opname == "LOAD_GLOBAL"}
    return sorted(used & function.__globals__.keys())


def _stamp(value: object, user: Callable[..., Any]) -> str:
    """Return text that identifies the value of a global, the same in every process."""
    if value is user or value is take or value is forget:
        return "itself"
    if is_kernel(value):
        return digest(value)
    if isinstance(value, bool | int | float | str | None):
        return repr(value)
    if isinstance(value, tuple):
        return f"({','.join(_stamp(item, user) for item in value)})"
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape}{hashlib.sha256(value.tobytes()).hexdigest()}"
    if isinstance(value, type):
        return _type_stamp(value)
    if isinstance(value, types.ModuleType | types.BuiltinFunctionType):
        return value.__name__
    raise TypeError(f"{user.__qualname__} uses {value!r}, which is neither a kernel nor a constant")


def _type_stamp(kind: Any) -> str:
    """Return text that identifies a type; a record's has the fields, whose places are in the machine code."""
    if not isinstance(kind, type):
        return repr(kind)
    fields = [(name, _type_stamp(kind.__annotations__[name])) for name in getattr(kind, "_fields", ())]
    return f"{kind.__module__}.{kind.__qualname__}{fields}"


@cache
def compiled_for_each(step: Callable[..., Any]) -> Callable[..., None]:
    """Return the compiled loop that runs a kernel on every row of its tables, on all cores.

    Args:
        step: a kernel of (row before, row after, parameters, an int), as a platform's `step`.

    Returns: a function of (rows before, rows after, parameters, an int), the tables float64 [vehicles, columns].
    """
    namespace = {"__name__": __name__, "step": _inner(step), "prange": _numba().prange}
    twin = types.FunctionType(_for_each.__code__, namespace, "for_each")
    twin.__module__ = __name__  # of which numba asks when it loads compiled code from the cache
    return _cached(twin, digest(step) + "-each", parallel=True)  # type: ignore[no-any-return]


def _for_each(before: Any, after: Any, parameters: Any, count: int) -> None:
    for index in prange(len(after)):  # type: ignore[name-defined]  # noqa: F821  # both names: compiled_for_each
        step(before[index], after[index], parameters[index], count)  # type: ignore[name-defined]  # noqa: F821


@cache
def _entry(function: Callable[..., Any]) -> Any:
    """Return the dispatcher that Python calls. The kernels inside it are in its code, not cached again."""
    return _cached(_twin(function), digest(function))


def _cached(twin: types.FunctionType, name: str, **options: bool) -> Any:
    """Return a dispatcher whose machine code is kept in the cache folder of this name.

    numba keys its cache by path, content and line of the source file too; the empty file in the folder takes its place,
    so that the digest alone decides, and an installation finds what a checkout compiled.
    """
    numba = _numba()
    folder = _own_folder(name)
    source = folder / "kernel.py"
    source.touch()
    twin.__code__ = twin.__code__.replace(co_filename=str(source), co_firstlineno=1)
    numba.config.CACHE_DIR = str(folder)
    return numba.njit(cache=True, fastmath=False, error_model="numpy", **options)(twin)


@cache
def _inner(function: Callable[..., Any]) -> Any:
    return _numba().njit(fastmath=False, forceinline=True, error_model="numpy")(_twin(function))


def _twin(function: Callable[..., Any]) -> types.FunctionType:
    """Return a copy of a kernel in which the kernels that it calls are dispatchers."""
    if not is_kernel(function):
        raise TypeError(f"{function.__qualname__} is not a kernel")
    namespace = dict(function.__globals__)
    for name in _global_names(function):
        value = namespace[name]
        if is_kernel(value) and value is not function:
            namespace[name] = _inner(value)
    twin = types.FunctionType(function.__code__, namespace, function.__name__, function.__defaults__)
    twin.__module__ = function.__module__
    twin.__qualname__ = function.__qualname__
    return twin


def _own_folder(name: str) -> Path:
    """Return the cache folder of one kernel, marked as used now. Making a new one removes old ones."""
    base = cache_folder()
    folder = base / name
    if folder.is_dir():
        os.utime(folder)
        return folder
    folder.mkdir(parents=True, exist_ok=True)
    _prune(base)
    return folder


@cache
def _prune(base: Path) -> None:
    """Remove what has not been used for KEEP_UNUSED_S; once in a process. Another process may do the same."""
    oldest = time.time() - KEEP_UNUSED_S
    for folder in base.iterdir():
        try:
            if folder.stat().st_mtime < oldest:
                shutil.rmtree(folder, ignore_errors=True)
        except FileNotFoundError:
            continue


@cache
def _numba() -> Any:
    numba: Any = import_module("numba")
    _lower_take()
    _lower_forget()
    return numba


def _lower_take() -> None:
    """Teach numba `kernels.take`: plain loads into a tuple, which compile faster than a generic slice."""
    types: Any = import_module("numba.core.types")
    cgutils: Any = import_module("numba.core.cgutils")
    extending: Any = import_module("numba.extending")

    def typing(_context: Any) -> Any:
        def typer(row: Any, start: Any, count: Any) -> Any:
            vector = isinstance(row, types.Array) and row.ndim == 1 and row.layout == "C"
            if vector and isinstance(start, types.Integer) and isinstance(count, types.IntegerLiteral):
                return types.UniTuple(row.dtype, count.literal_value)
            return None  # numba then says that no such call is known

        return typer

    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        row, start, _ = signature.args
        data = context.make_array(row)(context, builder, arguments[0]).data
        first = context.cast(builder, arguments[1], start, types.intp)
        values = []
        for index in range(signature.return_type.count):
            at = builder.add(first, context.get_constant(types.intp, index))
            values.append(context.unpack_value(builder, row.dtype, cgutils.gep(builder, data, at)))
        return context.make_tuple(builder, signature.return_type, values)

    extending.type_callable(take)(typing)
    extending.lower_builtin(take, types.Array, types.Integer, types.IntegerLiteral)(lower)


def _lower_forget() -> None:
    """Teach numba `kernels.forget`: an empty instruction of which the compiler believes that it changes memory."""
    types: Any = import_module("numba.core.types")
    extending: Any = import_module("numba.extending")
    ir: Any = import_module("llvmlite.ir")

    def lower(context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        builder.asm(ir.FunctionType(ir.VoidType(), []), "", "~{memory}", [], True)
        return context.get_dummy_value()

    extending.type_callable(forget)(lambda _context: lambda: types.none)
    extending.lower_builtin(forget)(lower)
