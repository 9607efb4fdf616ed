"""ROS 1 packages in Python, made of this project's own definitions by Debian's genpy."""

import subprocess
from pathlib import Path

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.definition_text import text_of

PYTHON = "/usr/bin/python3"
_GENERATOR = "/usr/lib/genpy/genmsg_py.py"


def make_packages(folder: Path, *packages: str) -> Path:
    """Write each package with all its messages into `folder`; other packages they use are this project's too."""
    registry = standard_registry()
    needed = {name.partition("/")[0] for name in registry.names()} - {"builtin_interfaces"}
    texts = folder / "texts"
    for name in registry.names():
        package, _, message = name.partition("/msg/")
        if package in needed and "_" not in message:
            path = texts / package / f"{message}.msg"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text_of(registry.definition(name), ros1=True), "utf-8")
    search = [f"-I{package}:{texts / package}" for package in needed]
    for package in packages:
        out = folder / package / "msg"
        out.mkdir(parents=True)
        (folder / package / "__init__.py").touch()
        files = [str(path) for path in sorted((texts / package).glob("*.msg"))]
        subprocess.run([PYTHON, _GENERATOR, "-p", package, "-o", str(out), *search, *files], check=True)
        subprocess.run([PYTHON, _GENERATOR, "--initpy", "-p", package, "-o", str(out)], check=True)
    return folder
