"""Load large modules in less time than Python takes by itself."""

import gc
from importlib import import_module
from types import ModuleType


def loaded(name: str) -> ModuleType:
    """Return a module by its full name, imported if need be.

    While a large one is imported, Python looks for garbage among all that it has made, again and again, though nearly
    all of it stays: a sixth of the time that it takes. Here it does not.
    """
    looks = gc.isenabled()
    gc.disable()
    try:
        return import_module(name)
    finally:
        if looks:
            gc.enable()
