import subprocess
import sys

import pytest

LOOKED = "looked = []; gc.callbacks.append(lambda phase, told: looked.append(phase))"


def told_by(*lines: str) -> list[str]:
    code = "\n".join(("import gc, sys", "from simconsole.values.host.loading import loaded", *lines))
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()


def test_no_garbage_is_looked_for_while_a_module_is_loaded() -> None:
    load = "module = loaded('simconsole.cli.drive')"
    same = "print(len(looked), gc.isenabled(), module is sys.modules['simconsole.cli.drive'])"
    assert told_by(LOOKED, load, same) == ["0", "True", "True"]


@pytest.mark.parametrize("enabled", [True, False])
@pytest.mark.parametrize("name", ["email.parser", "no_such_module"])
def test_it_is_looked_for_afterwards_as_before(enabled: bool, name: str) -> None:
    before = "" if enabled else "gc.disable()"
    assert told_by(before, f"try: loaded({name!r})\nexcept ImportError: pass", "print(gc.isenabled())") == [
        str(enabled)
    ]
