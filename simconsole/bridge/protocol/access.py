"""Who may do what: tokens, the roles they give, and rosauth's way of showing one.

view: subscribe and ask about the console. publish: talk to other clients too. control: command the console.
"""

import hashlib
import hmac
from collections.abc import Callable, Mapping
from enum import IntEnum
from typing import Final

from simconsole.bridge.protocol.operations import Auth
from simconsole.profiles.bridge import BridgeLimits
from simconsole.values.errors import ProfileError, RemoteProtocolError

MIN_TOKEN: Final = 16
WRONG_TOKENS_PER_S: Final = 100
"""As many wrong tokens are looked at in a second; after them none is, so that nobody finds one by trying."""
STAMP_S: Final = 5.0
"""How far the time `t` of rosauth's clients may be from now; each of their macs is good once."""


class Role(IntEnum):
    """What a client may do; each includes those below."""

    NONE = 0
    VIEW = 1
    PUBLISH = 2
    CONTROL = 3


def message_limit(role: Role, limits: BridgeLimits) -> int:
    """Return the bytes that a message of a client may have."""
    if role >= Role.PUBLISH:
        return limits.message_bytes
    return min(limits.message_bytes, limits.viewer_message_bytes)


class Access:
    """The tokens of one server."""

    def __init__(self, tokens: Mapping[str, Role], anonymous: Role, wall_s: Callable[[], float] = lambda: 0.0) -> None:
        """Give each token its role; `anonymous` is that of a client without one, `wall_s` says the time since 1970."""
        self._tokens = dict(tokens)
        self.anonymous = anonymous
        self._wall_s = wall_s
        self._wrong = 0
        self._wrong_since_s = 0.0
        self._shown: dict[str, float] = {}
        """Macs that were good, and when each is too old anyway."""

    @property
    def has_tokens(self) -> bool:
        """Whether a token is asked for."""
        return bool(self._tokens)

    def role_of(self, token: str) -> Role:
        """Return the role of a token.

        Raises:
            RemoteProtocolError: it is none of this server's.
        """
        return self._role(lambda known: hmac.compare_digest(known.encode(), token.encode("utf-8", "replace")))

    def admit(self, auth: Auth) -> Role:
        """Return the role that an auth operation shows: by a token, or by rosauth's SHA-512 over token and fields.

        Raises:
            RemoteProtocolError: it shows none.
        """
        if auth.token or not self._tokens:
            return self.role_of(auth.token) if self._tokens else self.anonymous
        now_s = self._wall_s()
        if abs(now_s - auth.t) > STAMP_S:
            raise RemoteProtocolError(f"t is not within {STAMP_S:g} s of this server's time")
        if auth.end <= now_s:
            raise RemoteProtocolError("end is over")
        mac = auth.mac.lower()
        self._shown = {known: until_s for known, until_s in self._shown.items() if until_s >= now_s}
        if mac in self._shown:
            raise RemoteProtocolError("this mac was shown before")
        shown = f"{auth.client}{auth.dest}{auth.rand}{auth.t}{auth.level}{auth.end}"

        def fits(known: str) -> bool:
            """Return whether the mac is that of a token."""
            digest = hashlib.sha512(f"{known}{shown}".encode("utf-8", "replace")).hexdigest()
            return hmac.compare_digest(digest.encode(), mac.encode("utf-8", "replace"))

        role = self._role(fits)
        self._shown[mac] = auth.t + STAMP_S
        return role

    def _role(self, fits: Callable[[str], bool]) -> Role:
        now_s = self._wall_s()
        if abs(now_s - self._wrong_since_s) >= 1.0:
            self._wrong, self._wrong_since_s = 0, now_s
        if self._wrong >= WRONG_TOKENS_PER_S:
            raise RemoteProtocolError("too many wrong tokens: try again in a second")
        # Every token is compared, so that the time taken reveals nothing.
        roles = [role for known, role in self._tokens.items() if fits(known)]
        if not roles:
            self._wrong += 1
            raise RemoteProtocolError("not a token of this server")
        return max(roles)


OPEN: Final = Access({}, Role.CONTROL)
"""A server for its own machine: every client may do everything."""


def read_tokens(text: str, name: str) -> dict[str, Role]:
    """Return the tokens of a file whose lines are `ROLE TOKEN`; empty lines and # comments are ignored.

    Raises:
        ProfileError: naming the file and the line.
    """
    roles = {role.name.lower(): role for role in Role if role is not Role.NONE}
    tokens: dict[str, Role] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.partition("#")[0].split()
        if not words:
            continue
        if len(words) != 2 or words[0] not in roles:
            raise ProfileError(f"{name}: line {number}: expected a role ({', '.join(roles)}) and a token")
        if len(words[1]) < MIN_TOKEN or words[1] in tokens:
            raise ProfileError(f"{name}: line {number}: a token has at least {MIN_TOKEN} characters and stands once")
        tokens[words[1]] = roles[words[0]]
    if not tokens:
        raise ProfileError(f"{name}: no token in it")
    return tokens
