"""The benchmark's clients: a callback for each message received, the same for every server measured.

picows carries them where it is installed: a client in Python would be slower than the servers it measures.
"""

import asyncio
import importlib.util
from collections.abc import Callable
from typing import Any, Protocol

from websockets.asyncio.client import ClientConnection
from websockets.asyncio.client import connect as connect_websockets
from websockets.exceptions import WebSocketException
from websockets.frames import Frame

from simconsole.bridge.protocol.frames import CLOSE
from simconsole.values.errors import BridgeError


class Peer(Protocol):
    """One client of a server."""

    def send(self, text: bytes) -> None:
        """Send a text message at once."""

    async def close(self) -> None:
        """Close the connection and wait for the answer."""


OnMessage = Callable[[], None]


def library() -> str:
    """Return which library the clients use: picows, or websockets where that is not installed."""
    return "websockets" if importlib.util.find_spec("picows") is None else "picows"


async def connect(url: str, on_message: OnMessage) -> Peer:
    """Connect; `on_message` is called for each message that comes.

    Raises:
        BridgeError: nobody listens there, or the server refused.
    """
    open_peer = _by_websockets if library() == "websockets" else _by_picows
    try:
        return await open_peer(url, on_message)
    except (OSError, WebSocketException, TimeoutError) as error:
        raise BridgeError(f"{url}: {error}") from None


class _WebsocketsPeer(ClientConnection):
    on_message: OnMessage

    def process_event(self, event: Any) -> None:
        if isinstance(event, Frame) and event.opcode < CLOSE:
            self.on_message()
        else:
            super().process_event(event)


class _Sender:
    def __init__(self, peer: _WebsocketsPeer) -> None:
        self._peer = peer

    def send(self, text: bytes) -> None:
        self._peer.protocol.send_text(text)
        self._peer.send_data()

    async def close(self) -> None:
        await self._peer.close()


async def _by_websockets(url: str, on_message: OnMessage) -> Peer:
    peer = await connect_websockets(url, compression=None, max_size=None, create_connection=_WebsocketsPeer)
    assert isinstance(peer, _WebsocketsPeer)
    peer.on_message = on_message
    return _Sender(peer)


async def _by_picows(url: str, on_message: OnMessage) -> Peer:
    from picows import WSCloseCode, WSError, WSFrame, WSListener, WSMsgType, WSTransport, ws_connect

    class Listener(WSListener):
        def on_ws_frame(self, transport: WSTransport, frame: WSFrame) -> None:
            """Count a message; answer the end of the connection."""
            if frame.msg_type == WSMsgType.TEXT and frame.fin:
                on_message()
            elif frame.msg_type == WSMsgType.CLOSE:
                transport.send_close(WSCloseCode.OK)
                transport.disconnect()

    class Link:
        def __init__(self, transport: WSTransport) -> None:
            self._transport = transport

        def send(self, text: bytes) -> None:
            """Send a text message at once."""
            self._transport.send(WSMsgType.TEXT, text)

        async def close(self) -> None:
            """Close the connection and wait for the answer, for a second at most."""
            self._transport.send_close(WSCloseCode.OK)
            try:
                await asyncio.wait_for(self._transport.wait_disconnected(), 1.0)
            except TimeoutError:
                self._transport.disconnect(False)

    try:
        transport, _ = await ws_connect(Listener, url)
    except WSError as error:
        raise BridgeError(f"{url}: {error}") from None
    return Link(transport)
