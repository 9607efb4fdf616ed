"""What server and client share of a WebSocket over sans-I/O websockets: whole texts out of frames."""

from typing import Final

from websockets.frames import Frame, Opcode

from simconsole.errors import RemoteProtocolError

RECEIVE_BYTES: Final = 65_536


class TextAssembler:
    """Joins the fragments of text messages. The protocol object has checked their order and total size."""

    def __init__(self, max_fragments: int) -> None:
        """Allow messages of at most `max_fragments` frames."""
        self._max_fragments = max_fragments
        self._parts: list[bytes] = []
        self._binary = False

    def add(self, frame: Frame) -> bytes | None:
        """Take one data frame; return the message when it is complete.

        Raises:
            RemoteProtocolError: a binary message, or more fragments than allowed (N13).
        """
        if frame.opcode is Opcode.CONT:
            self._parts.append(bytes(frame.data))
        elif frame.fin and frame.opcode is Opcode.TEXT:
            return bytes(frame.data)
        else:
            self._binary = frame.opcode is Opcode.BINARY
            self._parts = [bytes(frame.data)]
        if not frame.fin:
            if len(self._parts) >= self._max_fragments:
                raise RemoteProtocolError(f"message is in more than {self._max_fragments} fragments")
            return None
        parts, self._parts = self._parts, []
        if self._binary:
            self._binary = False
            raise RemoteProtocolError("binary messages are not supported here")
        return b"".join(parts)


def is_data(frame: Frame) -> bool:
    """Return whether a frame carries part of a message, and is not ping, pong or close."""
    return frame.opcode is Opcode.TEXT or frame.opcode is Opcode.CONT or frame.opcode is Opcode.BINARY
