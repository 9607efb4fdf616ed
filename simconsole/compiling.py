"""Compile kernels with numba: the fast twin of the plain functions.

Each kernel is copied with the kernels it calls replaced by their compiled twins. The cache folder carries the hash
of all of simconsole's sources, because numba does not notice an edited callee in another file.
"""

import hashlib
import os
import types
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from simconsole.kernels import is_kernel, take

F = TypeVar("F", bound=Callable[..., Any])


def plain(function: F) -> F:
    """Return `function` itself: the execution without numba, bit-identical and about a hundred times slower."""
    return function


def compiled(function: F) -> F:
    """Return the compiled twin of a kernel. Compiles at its first call, or loads from the user's cache."""
    return _dispatcher(function)  # type: ignore[no-any-return]


def cache_folder() -> Path:
    """Return the numba cache folder of exactly these sources (`XDG_CACHE_HOME` is honoured)."""
    digest = hashlib.sha256()
    package = Path(__file__).parent
    for source in sorted(package.rglob("*.py")):
        digest.update(source.relative_to(package).as_posix().encode())
        digest.update(source.read_bytes())
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "simconsole" / "numba" / digest.hexdigest()[:16]


@cache
def _dispatcher(function: Callable[..., Any]) -> Any:
    if not is_kernel(function):
        raise TypeError(f"{function.__qualname__} is not a kernel")
    numba = _numba()
    namespace = dict(function.__globals__)
    for name in function.__code__.co_names:
        value = namespace.get(name)
        if is_kernel(value) and value is not function:
            namespace[name] = _dispatcher(value)  # type: ignore[arg-type]
    twin = types.FunctionType(function.__code__, namespace, function.__name__, function.__defaults__)
    twin.__module__ = function.__module__
    twin.__qualname__ = function.__qualname__
    return numba.njit(cache=True, fastmath=False)(twin)


@cache
def _numba() -> Any:
    import numba
    from numba.extending import overload
    from numba.np.unsafe.ndarray import to_fixed_tuple

    folder = cache_folder()
    folder.mkdir(parents=True, exist_ok=True)
    numba.config.CACHE_DIR = str(folder)

    @overload(take)
    def _take(row: Any, start: Any, count: Any) -> Any:
        def implementation(row: Any, start: Any, count: Any) -> Any:
            return to_fixed_tuple(row[start : start + count], count)

        return implementation

    return numba
