"""The picture of the operators' desk in docs, of the drive that goes on: `python scripts/make_desk_picture.py FILE`.

Serves the drive as `simconsole view` does, opens rerun's viewer in a headless Chromium, which draws with the
processor, and waits until the picture has come.
"""

import argparse
import base64
import io
import itertools
import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from PIL import Image
from websockets.sync.client import ClientConnection, connect

from simconsole.processes.running_scene import newest_scene
from simconsole.scene.viewer.scene_server import SceneServer

SIZE_PX = (1920, 1080)
COLOURS = 128
OPTIONS = (
    "--headless=new",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
    "--remote-allow-origins=*",
)
START_S = 30.0
LOOK_S = 0.05


class Page:
    """The browser's only page, through Chromium's DevTools protocol."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket, self._numbers = socket, itertools.count(1)

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Return what the browser answers."""
        number = next(self._numbers)
        self._socket.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.recv())
            if answer.get("id") == number:
                return dict(answer["result"])


def devtools(folder: Path) -> str:
    """Return the address of a new page of the browser whose profile is in `folder`, once it is there."""
    import urllib.request

    told, deadline_s = folder / "DevToolsActivePort", time.monotonic() + START_S
    while not (told.exists() and "\n" in told.read_text()):
        if time.monotonic() > deadline_s:
            sys.exit(f"Chromium does not start within {START_S:g} s")
        time.sleep(LOOK_S)
    port = told.read_text().split("\n")[0]
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/json") as answer:
        pages = json.load(answer)
    return str(next(page["webSocketDebuggerUrl"] for page in pages if page["type"] == "page"))


def picture(server: SceneServer, wait_s: float, renderer: str) -> bytes:
    """Return the desk as PNG, `wait_s` after the viewer was opened; the drive is served on meanwhile."""
    program = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if program is None:
        sys.exit("no Chromium: system-packages.txt")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        words = [program, *OPTIONS, f"--user-data-dir={folder}", "--window-size={},{}".format(*SIZE_PX)]
        browser = subprocess.Popen([*words, "about:blank"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            with connect(devtools(Path(folder)), max_size=None) as socket:
                page = Page(socket)
                dark = [{"name": "prefers-color-scheme", "value": "dark"}]
                page.call("Emulation.setEmulatedMedia", features=dark)
                width, height = SIZE_PX
                page.call(
                    "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False
                )
                page.call("Page.navigate", url=f"{server.addresses.browser}&renderer={renderer}&hide_welcome_screen=1")
                deadline_s = time.monotonic() + wait_s
                while time.monotonic() < deadline_s:
                    server.pump()
                    time.sleep(LOOK_S)
                return base64.b64decode(page.call("Page.captureScreenshot", format="png")["data"])
        finally:
            browser.kill()
            browser.wait()


def main() -> None:
    """Serve, wait, write the picture with few colours: a small file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("picture", type=Path)
    parser.add_argument("--scene", type=Path, metavar="FILE.rrd", help="in place of the drive's that goes on")
    parser.add_argument("--wait", type=float, default=30.0, metavar="S", help="how long the viewer has to draw")
    parser.add_argument("--renderer", default="webgl", choices=("webgl", "webgpu"))
    given = parser.parse_args()
    server = SceneServer(given.scene or newest_scene().path)
    try:
        content = picture(server, given.wait, given.renderer)
    finally:
        server.close()
    image = Image.open(io.BytesIO(content)).convert("RGB")
    image.quantize(COLOURS, dither=Image.Dither.NONE).save(given.picture, optimize=True)
    print(f"{given.picture}: {given.picture.stat().st_size} bytes")


if __name__ == "__main__":
    main()
