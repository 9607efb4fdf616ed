"""The operator's acts as a service: what `/console/request` asks, with a note, a participant's and a trial's id.

Acts become edges of a tick, as from the wheel's buttons; the words that no row can hold are kept beside the drive.
"""

from collections.abc import Callable
from typing import Any, Final

from msgspec import Struct

from simconsole.bridge.console.command_decoder import REQUESTS
from simconsole.values.errors import BridgeError

OPERATE: Final = "/console/operate"
OPERATE_TYPE: Final = "simconsole_msgs/Operate"
NOTE_CHARS: Final = 500
ID_CHARS: Final = 64
ACTS_MAX: Final = 1000
"""As many are kept of a drive: the manifest that holds them has a bound."""


class Act(Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One act of an operator, after `tick`."""

    tick: int
    act: str
    note: str = ""
    participant: str = ""
    trial: str = ""


OnAct = Callable[[Act], None]


class Operator:
    """Handles the operator's acts: raises their events and passes the texts on."""

    def __init__(self, raise_events: Callable[[int], None], on_act: OnAct) -> None:
        """Raise masks of `signals.Event` with `raise_events`, report acts with `on_act`."""
        self._raise_events = raise_events
        self._on_act = on_act
        self._kept = 0
        self.tick = 0
        """The newest tick that was published."""

    def operate(self, args: dict[str, Any], *_: object) -> dict[str, Any]:
        """Do one act; whether arbitration grants it appears on `/console/arbitration`, as for any other request.

        Raises:
            BridgeError: no such act, or a text is too long.
        """
        name = str(args.get("act", ""))
        event = REQUESTS.get(name)
        if event is None:
            raise BridgeError(f"act: {name[:ID_CHARS]!r} is not one of {', '.join(REQUESTS)}")
        act = Act(
            tick=self.tick,
            act=name,
            note=_text(args, "note", NOTE_CHARS),
            participant=_text(args, "participant", ID_CHARS),
            trial=_text(args, "trial", ID_CHARS),
        )
        self._raise_events(int(event))
        if self._kept < ACTS_MAX:
            self._kept += 1
            self._on_act(act)
        return {"accepted": True, "tick": self.tick}


def _text(args: dict[str, Any], key: str, most: int) -> str:
    text = str(args.get(key, ""))
    if len(text) > most or not text.isprintable():
        raise BridgeError(f"{key}: at most {most} printable characters")
    return text


def summarise_acts(acts: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the acts for a drive's summary: all of them, and the last participant and trial named."""
    if not acts:
        return {}
    named: dict[str, Any] = {}
    for key in ("participant", "trial"):
        values = [act[key] for act in acts if act.get(key)]
        if values:
            named[key] = values[-1]
    return {**named, "acts": acts}
