"""A user's own message types: the `.msg`, `.srv` and `.action` files of a folder laid out as ROS has its packages."""

from pathlib import Path
from typing import Final

from simconsole.bridge.messages import Registry, standard_registry
from simconsole.bridge.messages.standard_types import definition_files
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import BridgeError, ProfileError

MAX_FILES: Final = 1000
MAX_BYTES: Final = 65_536


def load_registry(profile: BridgeProfile) -> Registry:
    """Return the standard types and those of the profile's folder, `PACKAGE/msg/NAME.msg` and so on.

    Raises:
        ProfileError: naming the file that cannot be read, or that uses a type which nobody defines.
    """
    registry = standard_registry()
    if profile.messages is None:
        return registry
    folder = Path(profile.messages)
    files = definition_files(folder)
    if not files:
        raise ProfileError(f"outputs.bridge.messages: {folder}: no PACKAGE/msg/NAME.msg, .srv or .action in it")
    if len(files) > MAX_FILES:
        raise ProfileError(f"outputs.bridge.messages: {folder}: {len(files)} files, at most {MAX_FILES}")
    known = set(registry.names())
    for path in files:
        try:
            registry.add_file(path, _read(path))
        except (BridgeError, UnicodeDecodeError, OSError) as error:
            raise ProfileError(f"outputs.bridge.messages: {path}: {error}") from None
    for name in set(registry.names()) - known:
        try:
            registry.struct(name)
        except BridgeError as error:
            raise ProfileError(f"outputs.bridge.messages: {folder}: {error}") from None
    return registry


def _read(path: Path) -> str:
    with path.open("rb") as file:
        data = file.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise BridgeError(f"more than {MAX_BYTES} bytes")
    return data.decode()
