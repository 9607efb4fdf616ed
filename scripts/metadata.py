"""What the package's metadata takes from the checkout that it is built in: its web address, and links that lead there.

Hatchling calls `Metadata`. The repository cannot know where it is hosted, but a clone can: by its remote `origin`.
Where that is no host that others reach (a folder, a machine without a domain), there are no URLs, and README.md stays
as it is.
"""

import re
import subprocess
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

_ORIGIN = re.compile(
    r"(?P<scheme>https?://|ssh://|)(?:[^@/]*@)?"  # who logs in, and with what, is nobody else's business
    r"(?P<host>(?:[a-z0-9-]+\.)+[a-z][a-z0-9-]+)(?P<port>:\d+(?=/))?[:/]/*(?P<path>[^?#]+?)(?:\.git)?/*",
    re.IGNORECASE,
)
_LINK = re.compile(r"\]\((?!\w+:|#)([^)\s]+)\)")
WHICH = " ADDRESS is this page's"
_RAW = (".gif", ".jpg", ".mp4", ".png", ".svg", ".webp")
"""Files that a browser gets as they are; of all others it gets a page."""


def address_of(origin: str) -> str | None:
    """Return the web address of a git remote, without a name or a token in it; None where there is none."""
    found = _ORIGIN.fullmatch(origin.strip())
    if found is None or (found["scheme"] == "" and ":" not in origin):
        return None
    if found["scheme"].startswith("http"):
        return f"{found['scheme']}{found['host']}{found['port'] or ''}/{found['path']}"
    return f"https://{found['host']}/{found['path']}"


def linked(readme: str, address: str) -> str:
    """Return a README whose links into the repository lead to `address`, in the form of GitHub and GitLab."""

    def absolute(link: re.Match[str]) -> str:
        kind = "raw" if link[1].partition("#")[0].endswith(_RAW) else "blob"
        return f"]({address}/{kind}/HEAD/{link[1]})"

    return _LINK.sub(absolute, readme).replace(f".{WHICH}", "").replace("ADDRESS", address)


class Metadata(MetadataHookInterface):
    """Fills in `urls` and `readme`."""

    PLUGIN_NAME = "custom"

    def update(self, metadata: dict[str, Any]) -> None:
        """Add the description, and the URLs where there are any."""
        readme = (Path(self.root) / "README.md").read_text("utf-8")
        address = address_of(self._origin())
        metadata["urls"] = {}
        if address is not None:
            readme = linked(readme, address)
            page = f"{address}/blob/HEAD"
            metadata["urls"] = {
                "Repository": address,
                "Documentation": f"{page}/docs/README.md",
                "Changelog": f"{page}/CHANGELOG.md",
                "Issues": f"{address}/issues",
            }
        metadata["readme"] = {"content-type": "text/markdown", "text": readme}

    def _origin(self) -> str:
        """Return the remote of the checkout, "" where there is no git, no checkout of its own or no remote."""
        if not (Path(self.root) / ".git").exists():  # it may lie in a checkout of something else
            return ""
        command = ["git", "-C", self.root, "remote", "get-url", "origin"]
        try:
            return subprocess.run(command, capture_output=True, text=True, check=True).stdout
        except (OSError, subprocess.CalledProcessError):
            return ""
