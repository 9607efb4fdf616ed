"""Import every module of the console; print how many, and a line for each that cannot be imported."""

import importlib
import pkgutil
import sys

import simconsole

failed = count = 0
for module in pkgutil.walk_packages(simconsole.__path__, "simconsole."):
    if module.name.endswith(".__main__"):
        continue
    count += 1
    try:
        importlib.import_module(module.name)
    except Exception as error:  # noqa: BLE001  # whatever it is
        failed += 1
        print(f"{module.name}: {type(error).__name__}: {error}")
print(count)
sys.exit(failed)
