"""The hash chain of every stream of a log, followed record by record."""

from simconsole.recording.framing import START_OF_CHAIN, Record, chain
from simconsole.recording.log_header import LogHeader


class Chains:
    """Says where the chain of a stream does not hold: something was changed, added or left out there.

    Attributes:
        digest: recorded hash of the state vectors up to the last record.
        broken: name of a stream to the first tick at which its chain does not hold.
    """

    def __init__(self, header: LogHeader) -> None:
        self.digest = START_OF_CHAIN
        self.broken: dict[str, int] = {}
        self._names = [stream.name for stream in header.streams]
        self._messages = [START_OF_CHAIN] * len(self._names)

    def follow(self, record: Record) -> None:
        """Follow all streams over one record; behind a break a chain goes on from what was recorded."""
        if chain(self.digest, record.tick, record.vector.tobytes()) != record.digest:
            self.broken.setdefault(self._names[0], record.tick)
        self.digest = record.digest
        for message in record.messages:
            if chain(self._messages[message.stream], record.tick, message.content) != message.digest:
                self.broken.setdefault(self._names[message.stream], record.tick)
            self._messages[message.stream] = message.digest

    def problems(self) -> list[str]:
        """Return one line for each stream whose chain does not hold."""
        return [f"stream {name}: the chained hash does not hold at tick {tick}" for name, tick in self.broken.items()]
