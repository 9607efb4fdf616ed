"""What pip leaves beside a package of one module, so that its entry points are found."""

from pathlib import Path


def installed(folder: Path, group: str, **named: str) -> None:
    """Register `named` (entry point: object of module quick) in a group, for whoever has `folder` on its path."""
    about = folder / "quick-0.1.0.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: quick\nVersion: 0.1.0\n")
    lines = "".join(f"{name} = quick:{value}\n" for name, value in named.items())
    (about / "entry_points.txt").write_text(f"[{group}]\n{lines}")
