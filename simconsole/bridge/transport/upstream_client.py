"""Keeps the console connected to another rosbridge server, in the event loop of its own server (shell)."""

import asyncio
import logging
import random
import ssl
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final, Literal

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidURI, WebSocketException
from websockets.uri import parse_uri

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.upstream import Upstream
from simconsole.bridge.protocol.backoff import DEAD_AFTER_S, PING_AFTER_S, Backoff
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.transport.client_log import log_outcome
from simconsole.profiles.bridge import UpstreamProfile
from simconsole.values.errors import ProfileError
from simconsole.values.units import NS_PER_S

_ATTEMPT_S: Final = 2.0
_MAX_MESSAGE_BYTES: Final = 16_777_216
_logger = logging.getLogger("simconsole.bridge.transport.upstream_client")


class UpstreamClient:
    """Connects, stays connected, and reconnects with everything registered again."""

    def __init__(
        self,
        console: ConsoleBridge,
        profile: UpstreamProfile,
        clock_ns: Callable[[], int] = time.monotonic_ns,
        backoff: Backoff | None = None,
    ) -> None:
        """Prepare; `run` does it.

        Raises:
            ProfileError: the address, or the file of the token or certificate, cannot be used.
        """
        try:
            uri = parse_uri(profile.url)
            self._tls = ssl.create_default_context(cafile=profile.certificate) if uri.secure else None
            self._token = None if profile.token is None else _read(profile.token)
        except (InvalidURI, OSError, ValueError) as error:
            raise ProfileError(f"outputs.bridge.upstream: {profile.url}: {error}") from None
        self._profile = profile
        self._console = console
        self._clock_ns = clock_ns
        self._backoff = backoff or Backoff()
        self._ready = asyncio.Event()
        self._upstream = Upstream(console, profile, self._ready.set)

    async def run(self) -> None:
        """Stay connected until cancelled."""
        chance = random.Random()
        self._set_state("connecting")
        headers = None if self._token is None else {"Authorization": f"Bearer {self._token}"}
        while True:
            try:
                async with connect(
                    self._profile.url,
                    ssl=self._tls,
                    additional_headers=headers,
                    compression=None,
                    open_timeout=_ATTEMPT_S,
                    close_timeout=_ATTEMPT_S,
                    ping_interval=PING_AFTER_S,
                    ping_timeout=DEAD_AFTER_S - PING_AFTER_S,
                    max_size=_MAX_MESSAGE_BYTES,
                    logger=_logger,
                ) as peer:
                    self._backoff.reset()
                    await self._exchange(peer)
                    reason = "closed by it"
            except (OSError, WebSocketException, TimeoutError) as error:
                reason = str(error)
            finally:
                if self._upstream.lost(self._clock_ns()):
                    _logger.warning("%s was commanding and is gone", self._profile.url)
                if self._console.router.upstream == "connected":
                    self._set_state("lost")
            _logger.info("%s: not connected: %s", self._profile.url, reason)
            await asyncio.sleep(self._backoff.pause_s(chance.random()))

    async def _exchange(self, peer: ClientConnection) -> None:
        for registration in self._upstream.connected(self._clock_ns()):
            await peer.send(registration, text=True)
        self._set_state("connected")
        _logger.info("%s: connected", self._profile.url)
        sender = asyncio.create_task(self._send(peer))
        try:
            async for message in peer:
                session = self._upstream.session
                data = message.encode() if isinstance(message, str) else Binary(message)
                outcome = self._upstream.receive(data, self._clock_ns())
                if session is not None:
                    log_outcome(_logger, session, outcome)
        finally:
            sender.cancel()

    async def _send(self, peer: ClientConnection) -> None:
        session = self._upstream.session
        assert session is not None
        while True:
            await self._ready.wait()
            self._ready.clear()
            try:
                while (text := session.next_text(self._clock_ns())) is not None:
                    async with asyncio.timeout(DEAD_AFTER_S):
                        await peer.send(text, text=True)
            except WebSocketException:
                return
            except TimeoutError:  # it takes nothing more, so that not even a ping would be sent
                peer.transport.abort()
                return
            due_ns = session.due_ns()
            if due_ns is not None:
                wait_s = max(0, due_ns - self._clock_ns()) / NS_PER_S
                asyncio.get_running_loop().call_later(wait_s, self._ready.set)

    def _set_state(self, state: Literal["connecting", "connected", "lost"]) -> None:
        self._console.router.upstream = state


def _read(name: str) -> str:
    return Path(name).read_text("utf-8").strip()
