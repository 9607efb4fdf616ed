"""Compile kernels with numba: a compiled twin for each plain function.

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
from collections import namedtuple
from collections.abc import Callable, Iterator
from enum import EnumType, Flag
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from secrets import token_hex
from typing import Any, Final, NamedTuple, TypeVar

import numpy as np

from simconsole.values.host import lowering
from simconsole.values.host.files import held_alone
from simconsole.values.host.loading import loaded
from simconsole.values.kernels import foreseen, forget, is_kernel, is_stage
from simconsole.values.layout import Part, read, write

F = TypeVar("F", bound=Callable[..., Any])

_COMPILER: Final = b"".join(Path(source).read_bytes() for source in (__file__, lowering.__file__))
"""Source of the compiler that this process runs: read at import, since the files may be edited afterwards."""

_OPTIONS: Final[dict[str, Any]] = {"fastmath": False, "error_model": "numpy", "_nrt": False}
"""A kernel's arrays are its caller's, it makes none: without numba's runtime it counts no references to them. Counting
took two thirds of the time of kernels that hand on tuples of arrays."""

_PRIMITIVES: Final = (forget, foreseen, read, write)
"""What `lowering` teaches numba to compile."""

_LOAD_GLOBAL, _EXTENDED_ARG = (dis.opmap[name] for name in ("LOAD_GLOBAL", "EXTENDED_ARG"))

KEEP_UNUSED_S: Final = 30 * 24 * 3600.0
"""Compiled code that nobody has loaded for a month is removed when something new is compiled."""


def plain(function: F) -> F:
    """Return `function` itself: the execution without numba, bit-identical and about a hundred times slower."""
    return function


def compiled(function: F) -> F:
    """Return the compiled twin of a kernel. Compiles at its first call, or loads from the user's cache.

    Raises:
        TypeError: `function` is not a kernel, or uses something that the digest cannot cover.
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
    text.update(_COMPILER)
    text.update(repr((function.__defaults__, is_stage(function))).encode())
    text.update(repr([(name, _type_stamp(kind)) for name, kind in function.__annotations__.items()]).encode())
    for code in _codes(function.__code__):
        text.update(code.co_code)
        text.update(repr([c for c in code.co_consts if not isinstance(c, types.CodeType)]).encode())
        text.update(repr((code.co_names, code.co_varnames)).encode())
    for name, value in sorted(_used(function).items()):
        text.update(f"{name}={_stamp(value, function)};".encode())
    return text.hexdigest()[:16]


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _codes(constant)


def _used(function: Callable[..., Any]) -> dict[str, Any]:
    """Return what a function uses from outside, by name: globals, and enclosed variables (its closure)."""
    names = {name for code in _codes(function.__code__) for name in global_names(code)}
    used = {name: function.__globals__[name] for name in names & function.__globals__.keys()}
    return used | _enclosed(function)


def global_names(code: types.CodeType) -> Iterator[str]:
    """Yield the names of the globals that a code object loads, as they come.

    `dis.get_instructions` tells the same, but was a twelfth of the time in which a short drive starts and ends.
    """
    longer = 0  # the upper bits of an argument that does not fit into a byte
    for operation, low in zip(code.co_code[::2], code.co_code[1::2], strict=True):
        argument = longer | low
        longer = argument << 8 if operation == _EXTENDED_ARG else 0
        if operation == _LOAD_GLOBAL:
            yield code.co_names[argument >> 1]  # the lowest bit: whether it is to be called


def _enclosed(function: Callable[..., Any]) -> dict[str, Any]:
    cells = function.__closure__ or ()
    return {name: cell.cell_contents for name, cell in zip(function.__code__.co_freevars, cells, strict=True)}


def _stamp(value: object, user: Callable[..., Any]) -> str:
    """Return text that identifies a value which a kernel uses from outside, the same in every process."""
    if value is user or any(value is one for one in _PRIMITIVES):
        return "itself"
    if is_kernel(value):
        return digest(value)
    if isinstance(value, bool | int | float | str | None):
        return repr(value)
    if isinstance(value, Part):
        return f"{value.start}{value.names}{_stamp(value.record, user)}"
    if isinstance(value, tuple):
        return f"({','.join(_stamp(item, user) for item in value)})"
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape}{hashlib.sha256(value.tobytes()).hexdigest()}"
    if isinstance(value, EnumType):
        return f"{value.__name__}{_numbers(value)}"
    if isinstance(value, type):
        return _type_stamp(value)
    if isinstance(value, types.ModuleType | types.BuiltinFunctionType):
        return value.__name__
    raise TypeError(f"{user.__qualname__} uses {value!r}, which is neither a kernel nor a constant")


def _type_stamp(kind: Any) -> str:
    """Return text that identifies a type; that of a record names its fields, for their offsets are compiled in."""
    return _class_stamp(kind) if isinstance(kind, type) else repr(kind)


@cache
def _class_stamp(kind: type) -> str:
    fields = [(name, _type_stamp(kind.__annotations__[name])) for name in getattr(kind, "_fields", ())]
    return f"{kind.__module__}.{kind.__qualname__}{fields}"


@cache
def compiled_for_each(step: Callable[..., Any]) -> Callable[..., None]:
    """Return the compiled loop that runs a kernel on every row of its tables, on all cores.

    Args:
        step: a kernel of (row before, row after, parameters, ground, an int), as a platform's `step`.

    Returns: a function of (rows before, rows after, parameters, grounds, which of them each vehicle is on, an int), the
        tables float64 [vehicles or grounds, columns].
    """
    twin = _closed(_for_each, prange=_numba().prange)
    late = _Late(twin, lambda: {"step": _for_numba(step)})
    return _cached(late, digest(step) + "-each", parallel=True, _nrt=True)  # type: ignore[no-any-return]


def _for_each(before: Any, after: Any, parameters: Any, grounds: Any, on: Any, count: int) -> None:
    for index in prange(len(after)):  # type: ignore[name-defined]  # noqa: F821  # both names: compiled_for_each
        ground = grounds[on[index]]
        step(before[index], after[index], parameters[index], ground, count)  # type: ignore[name-defined]  # noqa: F821


@cache
def _entry(function: Callable[..., Any]) -> Any:
    """Return the dispatcher that Python calls, and kernels call of a stage. The other kernels are in its code."""
    dispatcher = _cached(_twin(function), digest(function))
    dispatcher.hold = partial(_held, function)
    return dispatcher


def _held(function: Callable[..., Any], held: tuple[Any, ...] | None) -> Callable[..., Any]:
    """Return the compiled twin with its first argument in memory, where compiled code finds it by its address."""
    kind = _numba().typeof(held)
    memory = np.zeros(lowering.size_of(kind), np.uint8)
    _keeper(kind)(memory.ctypes.data, held)
    found = _Holding(_caller(function, kind), memory.ctypes.data)
    found.arrays = memory, held  # as long as somebody may call it
    return found


class _Holding(partial[Any]):
    """A call with an address, which means nothing in another process."""

    arrays: tuple[Any, ...] = ()

    def __reduce__(self) -> Any:
        raise TypeError("compiled code that holds arrays cannot be handed to another process")


@cache
def _keeper(kind: Any) -> Any:
    """Return the dispatcher that writes values of a numba type at an address."""
    late = _Late(_closed(_keep), lambda: {"keep": lowering.memory_of(kind)[0]})
    return _cached(late, f"{_kind_stamp(kind)}-keep")


def _keep(address: int, held: Any) -> None:
    keep(address, held)  # type: ignore[name-defined]  # noqa: F821  # by _closed, like those of _with_kept


@cache
def _caller(function: Callable[..., Any], kind: Any) -> Any:
    """Return the dispatcher of a kernel whose first argument, of this numba type, is given by its address."""
    late = _Late(_closed(_with_kept), lambda: {"kept": lowering.memory_of(kind)[1], "function": _for_numba(function)})
    return _cached(late, f"{digest(function)}-{_kind_stamp(kind)}")


def _with_kept(address: int, *others: Any) -> Any:
    return function(kept(address), *others)  # type: ignore[name-defined]  # noqa: F821


def _kind_stamp(kind: Any) -> str:
    return hashlib.sha256(_COMPILER + str(kind).encode()).hexdigest()[:16]


def _closed(function: Callable[..., Any], /, **names: Any) -> types.FunctionType:
    """Return a copy of a function whose globals are these names."""
    twin = types.FunctionType(function.__code__, {"__name__": __name__, **names}, function.__name__)
    twin.__module__ = __name__  # numba asks for it when it loads compiled code from the cache
    return twin


class _Late(NamedTuple):
    """A function, and what gives the kernels that it uses: only who compiles it makes them, for that takes a while."""

    twin: Any  # a types.FunctionType, which type checkers bind as a method
    used: Callable[[], dict[str, Any]]

    def complete(self) -> types.FunctionType:
        """Return the function with all that it uses: globals, and enclosed variables (its closure)."""
        used, twin = self.used(), self.twin
        twin.__globals__.update(used)
        for name, cell in zip(twin.__code__.co_freevars, twin.__closure__ or (), strict=True):
            cell.cell_contents = used[name]
        return twin  # type: ignore[no-any-return]


def _cached(late: _Late, name: str, **options: bool) -> Any:
    """Return a dispatcher whose machine code is kept in the cache folder of this name.

    numba keys its cache by path, content and line of the source file too; the empty file in the folder takes its place,
    so that the digest alone decides, and an installation finds what a checkout compiled. It would also key by the bytes
    of enclosed values, which for a dispatcher differ in every process.
    """
    numba, twin = _numba(), late.twin
    folder = _own_folder(name)
    source = folder / "kernel.py"
    source.touch()
    twin.__code__ = twin.__code__.replace(co_filename=str(source), co_firstlineno=1)
    numba.config.CACHE_DIR = str(folder)
    dispatcher = numba.njit(cache=True, **{**_OPTIONS, **options})(_named(twin, name))
    kept = dispatcher._cache
    kept._index_key = lambda signature, codegen: (signature, codegen.magic_tuple())
    # numba numbers the files of a folder, one for each signature. Two processes that compile at once, each for another
    # signature, would write the same file, and the index might tell that it is for the one whose code it is not.
    kept._cache_file._data_name_pattern = f"{twin.__name__}-{token_hex(8)}.{{number:d}}.nbc"
    load = kept.load_overload if options.get("_nrt") else kept._load_overload
    kept.load_overload = partial(_loaded, kept, load, late)
    dispatcher.compile = partial(_alone, folder / "lock", dispatcher.compile)
    return dispatcher


def _alone(lock: Path, compile_one: Callable[[Any], Any], signature: Any) -> Any:
    """Compile or load one signature while no other process compiles the kernel: the second one then finds it compiled.

    Processes that start together would each compile the same for many seconds. A kernel holds its own lock while it
    waits for those of kernels that it calls, which never call it; numba's lock comes first, as it is one for all.
    """
    with import_module("numba.core.compiler_lock").global_compiler_lock, held_alone(lock):
        return compile_one(signature)


def _loaded(kept: Any, load: Callable[..., Any], late: _Late, *arguments: Any) -> Any:
    """Return what the cache holds of a signature; where it holds nothing, make the function ready to be compiled.

    numba's own way first imports all that it compiles with (scipy too, where there is one): a third of a second in each
    process, for code that is there. The compiler imports it by itself; only code that counts references needs it.
    """
    with kept._guard_against_spurious_io_errors():
        code = load(*arguments)
    if code is None:
        late.complete()
    return code


@cache
def _inner(function: Callable[..., Any]) -> Any:
    twin = _twin(function).complete()
    options = {"pipeline_class": lowering.compiler_of_inlined(), "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    return _numba().njit(forceinline=True, **options, **_OPTIONS)(_named(twin, digest(function)))


def _named(twin: types.FunctionType, name: str) -> types.FunctionType:
    """Give a function a name of its own, for the linker.

    numba tells functions of one name apart by a number, counted in each process anew. Of two in one process whose code
    comes from the cache, compiled by two others, it may be the same: who calls the second is then linked to the first.
    """
    twin.__qualname__ = f"{twin.__qualname__}_{name}"
    return twin


def _twin(function: Callable[..., Any]) -> _Late:
    """Return a copy of a kernel that uses dispatchers for kernels, and numbers for members of enumerations."""
    if not is_kernel(function):
        raise TypeError(f"{function.__qualname__} is not a kernel")
    cells = tuple(types.CellType() for _ in function.__code__.co_freevars)
    twin = types.FunctionType(
        function.__code__, dict(function.__globals__), function.__name__, function.__defaults__, cells
    )
    twin.__module__ = function.__module__
    twin.__qualname__ = function.__qualname__
    return _Late(twin, lambda: _twins_of(function))


def _twins_of(function: Callable[..., Any]) -> dict[str, Any]:
    """Return what a kernel uses from outside, as its twin uses it."""
    return {name: one if one is function else _for_numba(one) for name, one in _used(function).items()}


def _for_numba(value: Any) -> Any:
    if is_kernel(value):
        return _entry(value) if is_stage(value) else _inner(value)
    return _numbers(value) if isinstance(value, EnumType) else value


@cache
def _numbers(codes: EnumType) -> Any:
    """Return the members of an enumeration as numbers: floats as in the state vector, of a mask ints."""
    number = int if issubclass(codes, Flag) else float
    names: Any = codes.__members__
    members = {name: number(member) for name, member in names.items()}
    return namedtuple(codes.__name__, members)(**members)


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
    numba: Any = loaded("numba")
    lowering.teach()
    return numba
