"""Chromium without a display, driven by its own DevTools protocol; WebGL is drawn by the processor."""

import base64
import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.request import urlopen

from websockets.sync.client import ClientConnection, connect

from tests.interop.programs import program
from tests.patience import PATIENCE_S, wait_until

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
OPTIONS = (
    "--headless=new",
    "--no-sandbox",  # as root, as in a container, there is none
    "--disable-dev-shm-usage",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--remote-debugging-port=0",
    "--no-first-run",
    "--js-flags=--liftoff-only",  # WebAssembly is compiled once, fast: a page is open for seconds
    "--disable-background-networking",
)

BETWEEN_PAGES = "Not attached to an active page"


class Page:
    """One page."""

    def __init__(self, web: ClientConnection) -> None:
        self._web = web
        self._number = 0
        self.complaints: list[Any] = []
        """Errors and warnings of its console, and exceptions that nobody caught."""
        for domain in ("Page", "Runtime"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Return a method's result."""
        heard = self._reply(method, **parameters)
        assert "error" not in heard, heard
        return dict(heard["result"])

    def _reply(self, method: str, **parameters: Any) -> dict[str, Any]:
        self._number += 1
        self._web.send(json.dumps({"id": self._number, "method": method, "params": parameters}))
        while True:
            heard = json.loads(self._web.recv(timeout=PATIENCE_S))
            if heard.get("id") == self._number:
                return dict(heard)
            if heard.get("method") == "Runtime.exceptionThrown":
                self.complaints.append(heard["params"]["exceptionDetails"])
            elif heard.get("method") == "Runtime.consoleAPICalled" and heard["params"]["type"] in ("error", "warning"):
                self.complaints.append([argument.get("value") for argument in heard["params"]["args"]])

    def value(self, expression: str) -> Any:
        """Return what a JavaScript expression is."""
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def screenshot(self) -> bytes:
        """Return the picture of it as a PNG."""

        def taken() -> str | None:
            """Return it; None while the browser is between two pages."""
            heard = self._reply("Page.captureScreenshot", format="png")
            if heard.get("error", {}).get("message") == BETWEEN_PAGES:
                return None
            assert "error" not in heard, heard
            return str(heard["result"]["data"])

        return base64.b64decode(wait_until(taken, "a page") or "")


@contextmanager
def browse(url: str, folder: Path, width_px: int, height_px: int, before: str = "") -> Iterator[Page]:
    """Open a page; `folder` is the browser's own. The script `before` runs before those of the page."""
    assert CHROMIUM is not None
    words = (CHROMIUM, *OPTIONS, f"--user-data-dir={folder}", "about:blank")
    told = folder / "DevToolsActivePort"
    with program({"HOME": str(folder), "PATH": "/usr/bin:/bin"}, *words) as chromium:
        wait_until(lambda: chromium.poll() or (told.exists() and "\n" in told.read_text()), "the browser")
        with connect(_debugger(told.read_text().split("\n")[0]), max_size=None, compression=None) as web:
            page = Page(web)
            page.call(
                "Emulation.setDeviceMetricsOverride",
                width=width_px,
                height=height_px,
                deviceScaleFactor=1,
                mobile=False,
            )
            page.call("Page.addScriptToEvaluateOnNewDocument", source=before)
            page.call("Page.navigate", url=url)
            yield page


def _debugger(port: str) -> str:
    """Return where the browser's one page is driven."""

    def found() -> list[str]:
        with urlopen(f"http://127.0.0.1:{port}/json/list", timeout=PATIENCE_S) as answer:
            return [one["webSocketDebuggerUrl"] for one in json.load(answer) if one["type"] == "page"]

    return wait_until(found, "a page")[0]
