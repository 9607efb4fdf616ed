import subprocess
import sys

import pytest

from simconsole.hud.gl.context import is_software, renderer_name, windowless_context
from simconsole.values.errors import WorkerError


def test_a_context_needs_no_window(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    context = windowless_context()
    assert context.version_code >= 330
    assert is_software(context) == any(word in renderer_name(context).lower() for word in ("llvmpipe", "softpipe"))
    context.release()


def test_no_context_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    import moderngl

    def refuse(**_: object) -> None:
        raise Exception("libEGL.so not loaded")  # as glcontext does

    monkeypatch.setattr(moderngl, "create_context", refuse)
    with pytest.raises(WorkerError, match=r"no OpenGL 3.3 without a window here: libEGL.so not loaded"):
        windowless_context()


def test_no_window_is_no_context() -> None:
    """In a process of its own: nothing is current there."""
    code = "from simconsole.hud.gl.context import context_of_window\ncontext_of_window()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "RuntimeError: Cannot detect window" in done.stderr
