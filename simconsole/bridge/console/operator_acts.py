"""The operator's acts as a service: what `/console/request` asks, with a note, a participant's and a trial's id.

Acts become edges of a tick, as from the wheel's buttons; the words that no row can hold lie beside it in the log.
"""

from collections.abc import Callable
from typing import Any, Final

import msgspec
from msgspec import Struct

from simconsole.bridge.console.command_decoder import REQUESTS
from simconsole.values.errors import BridgeError
from simconsole.values.signals import Event

OPERATE: Final = "/console/operate"
OPERATE_TYPE: Final = "simconsole_msgs/Operate"
NOTE_CHARS: Final = 500
ID_CHARS: Final = 64
ACTS_MAX: Final = 128
"""As many are kept until the next tick takes them; the words of more are refused."""
ACT_BYTES: Final = 4096
"""No act is larger as JSON: that many characters of four bytes, and the names of its fields."""
SUMMARY_BYTES: Final = 1 << 17
"""As much of them stands in a drive's summary, for a manifest has a bound; the log holds all."""


class Act(Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One act of an operator, after `tick`."""

    tick: int
    act: str
    note: str = ""
    participant: str = ""
    trial: str = ""


OnAct = Callable[[Act], bool]
"""Takes an act; returns False where there is no room for its words."""


class Operator:
    """Handles the operator's acts: raises their events and passes the texts on."""

    def __init__(self, raise_events: Callable[[int], None], on_act: OnAct) -> None:
        """Raise masks of `signals.Event` with `raise_events`, report acts with `on_act`."""
        self._raise_events = raise_events
        self._on_act = on_act
        self.tick = 0
        """The newest tick that was published."""

    def operate(self, args: dict[str, Any], *_: object) -> dict[str, Any]:
        """Do one act; whether arbitration grants it appears on `/console/arbitration`, as for any other request.

        Raises:
            BridgeError: no such act, or a text is too long; or there is no room for the texts, then the act is done.
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
        kept = self._on_act(act)  # before its edge: the words of an act are never in a later tick than the act
        self._raise_events(int(event | Event.OPERATOR))
        if not kept and (act.note or act.participant or act.trial):
            raise BridgeError(f"act: {name} is done, but what came with it cannot be recorded: too many at once")
        return {"accepted": True, "tick": self.tick}


def _text(args: dict[str, Any], key: str, most: int) -> str:
    text = str(args.get(key, ""))
    if len(text) > most or not text.isprintable():
        raise BridgeError(f"{key}: at most {most} printable characters")
    return text


class ActsSummary:
    """What a drive's summary says of its acts: the first ones, how many more, the last participant and trial named."""

    def __init__(self) -> None:
        self._named: dict[str, str] = {}
        self._acts: list[dict[str, Any]] = []
        self._room_bytes = SUMMARY_BYTES
        self._more = 0

    def add(self, content: bytes) -> None:
        """Add an act, a message of the stream of acts."""
        act = msgspec.json.decode(content, type=dict[str, Any])
        self._named |= {key: act[key] for key in ("participant", "trial") if act.get(key)}
        self._room_bytes -= len(content)
        if self._room_bytes >= 0:
            self._acts.append(act)
        else:
            self._more += 1

    def summary(self) -> dict[str, Any]:
        """Return it as plain values, empty without an act."""
        if not self._acts:
            return {}
        more = {"more_acts": self._more} if self._more else {}
        return {**self._named, "acts": list(self._acts), **more}
