"""Message counts and link state of a server, for the topic /console/bridge and the report at a drive's end."""

from typing import Any, Final

from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.lease import CommandDesk
from simconsole.bridge.protocol.server_protocol import Router
from simconsole.values.labels import LINK_COMMANDER, LINK_CONNECTING, LINK_LOST, LINK_NOBODY, LINK_RETRYING

_UPSTREAM: Final = {"connecting": LINK_CONNECTING, "lost": LINK_RETRYING}


def bridge_status(router: Router, desk: CommandDesk, now_ns: int) -> dict[str, Any]:
    """Return the counts of all clients, present and gone, and of each that is there, by the topic's field names.

    The commander is that of the platform whose `desk` it is.
    """
    holder = desk.lease.holder(now_ns)
    sessions = router.sessions
    return {
        "commander": next((session.peer for session in sessions if session.number == holder), ""),
        "upstream": router.upstream,
        "state": link_state(router, now_ns, desk),
        "connections": router.connections,
        **router.counts()._asdict(),
        "clients": [_client_counts(session) for session in sessions],
    }


def link_state(router: Router, now_ns: int, desk: CommandDesk | None = None) -> str:
    """Return the link's state, in the word that driver and operator read (`simconsole.values.labels`).

    It is that of the platform whose `desk` it is, of the first platform without.
    """
    if router.upstream in _UPSTREAM:
        return _UPSTREAM[router.upstream]
    if (desk or router.desk).lease.holder(now_ns) is not None:
        return LINK_COMMANDER
    count = len(router.sessions)
    if count:
        return f"{count} clients" if count > 1 else "1 client"
    return LINK_LOST if router.connections else LINK_NOBODY


def total_counts(router: Router) -> dict[str, int]:
    """Return the counts of all clients together."""
    return {"connections": router.connections, **router.counts()._asdict()}


def _client_counts(session: ClientSession) -> dict[str, Any]:
    return {
        "peer": session.peer,
        "role": session.role.name.lower(),
        **session.counts()._asdict(),
        "waiting_bytes": session.send_queue.bytes,
        "topics": list(session.queues),
        "topics_dropped": [queue.dropped for queue in session.queues.values()],
    }
