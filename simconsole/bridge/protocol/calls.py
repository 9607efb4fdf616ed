"""Services and actions between clients, and services of the console itself.

Every call has an end: an answer, its time limit, or the end of either side; nothing of it is kept after that. A call
never waits for another, so that one slow provider holds up nobody else.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

from simconsole.bridge.messages import Registry
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.client_session import ClientSession, resolve_topic
from simconsole.bridge.protocol.operations import (
    ABORTED,
    ActionFeedback,
    ActionResult,
    AdvertiseAction,
    AdvertiseService,
    CallOperation,
    CallService,
    CancelActionGoal,
    Id,
    SendActionGoal,
    ServiceResponse,
    UnadvertiseAction,
    UnadvertiseService,
)
from simconsole.bridge.protocol.pending_calls import (
    NOBODY,
    Builtin,
    Caller,
    Forward,
    Handler,
    HeldCalls,
    NodeRequest,
    OpenCall,
    Provider,
    Survey,
    SurveyAnswers,
    answer_forwarded,
    arguments_by_name,
    checked_values,
    send,
)
from simconsole.profiles.bridge import BridgeLimits
from simconsole.values.errors import BridgeError, RemoteProtocolError
from simconsole.values.units import NS_PER_S


class Calls:
    """All services and actions of one server."""

    def __init__(self, registry: Registry, limits: BridgeLimits) -> None:
        """Start without any."""
        self._registry = registry
        self._limits = limits
        self._builtins: dict[str, Builtin] = {}
        self._services: dict[str, Provider] = {}
        self._actions: dict[str, Provider] = {}
        self._calls: dict[str, OpenCall] = {}
        self.held = HeldCalls(limits)
        self._numbers = 0
        self._next_deadline_ns: int | None = None

    @property
    def open(self) -> int:
        """Calls that wait for their answer."""
        return len(self._calls) + len(self.held)

    def add_builtin(self, name: str, type_name: str, handler: Handler, role: Role = Role.VIEW) -> None:
        """Add a service of the console, for clients of at least `role`."""
        self._builtins[name] = Builtin(type_name, handler, role)

    def services(self) -> dict[str, str]:
        """Return the type of every service by name."""
        everything: dict[str, Builtin | Provider] = {**self._builtins, **self._services}
        return {name: entry.type for name, entry in sorted(everything.items())}

    def actions(self) -> dict[str, str]:
        """Return the type of every action by name."""
        return {name: provider.type for name, provider in sorted(self._actions.items())}

    def providers(self) -> dict[str, int]:
        """Return the number of the client that provides each service of a client."""
        return {name: provider.session.number for name, provider in self._services.items()}

    def action_providers(self) -> dict[str, int]:
        """Return the number of the client that provides each action."""
        return {name: provider.session.number for name, provider in self._actions.items()}

    def apply(self, session: ClientSession, operation: CallOperation, now_ns: int) -> str:
        """Apply one operation of a client; return the service or action it is about.

        Raises:
            RemoteProtocolError: it cannot be applied. A failed call is answered and raises nothing.
        """
        if isinstance(operation, CallService | ServiceResponse | AdvertiseService | UnadvertiseService):
            name = resolve_topic(operation.service)
        else:
            name = resolve_topic(operation.action)
        match operation:
            case CallService():
                self._call(session, name, operation, now_ns)
            case ServiceResponse():
                self._respond(session, name, operation)
            case AdvertiseService() | AdvertiseAction():
                self._advertise(session, name, operation)
                for held in self.held.release(name, now_ns):
                    self.apply(held.session, held.operation, now_ns)
            case UnadvertiseService() | UnadvertiseAction():
                self._unadvertise(session, name, operation)
            case SendActionGoal():
                self._goal(session, name, operation, now_ns)
            case CancelActionGoal():
                self._cancel(session, name, operation)
            case ActionFeedback():
                self._feedback(session, name, operation)
            case _:
                self._result(session, name, operation)
        return name

    def reject(self, session: ClientSession, operation: CallService | SendActionGoal, reason: str) -> None:
        """Answer a call or goal of a client that may not make any: it would wait for ever."""
        if isinstance(operation, CallService):
            Caller(session, operation.id, operation.service, None, "none").respond(reason, False)
        else:
            Caller(session, operation.id, operation.action, None, "none").end(reason, ABORTED, False)

    def expire(self, now_ns: int) -> None:
        """End the calls that have timed out; cheap when there are none."""
        if self._next_deadline_ns is None or now_ns < self._next_deadline_ns:
            return
        for held in self.held.expire(now_ns):
            self.reject(held.session, held.operation, f"{held.name}: {NOBODY}")
        for identifier, call in list(self._calls.items()):
            if call.deadline_ns is not None and now_ns >= call.deadline_ns:
                del self._calls[identifier]
                self._fail(call, "no answer within the time limit")
        deadlines_ns = [call.deadline_ns for call in self._calls.values() if call.deadline_ns is not None]
        self._next_deadline_ns = min((*deadlines_ns, *self.held.deadlines_ns()), default=None)

    def disconnect(self, session: ClientSession) -> None:
        """Remove everything of a client: what it provides, its own calls, and calls to it."""
        self.held.disconnect(session)
        for table in (self._services, self._actions):
            for name in [name for name, provider in table.items() if provider.session is session]:
                del table[name]
        for identifier, call in list(self._calls.items()):
            if call.caller.session is session:
                del self._calls[identifier]
                if call.is_goal:
                    send(call.provider, op="cancel_action_goal", action=call.name, id=identifier)
            elif call.provider is session:
                del self._calls[identifier]
                self._fail(call, "whoever was asked is gone")

    def _advertise(self, session: ClientSession, name: str, operation: AdvertiseService | AdvertiseAction) -> None:
        table = self._services if isinstance(operation, AdvertiseService) else self._actions
        known = table.get(name)
        if name in self._builtins or (known is not None and known.session is not session):
            raise RemoteProtocolError("somebody else provides it already")
        count = sum(not each.session.in_graph for each in (*self._services.values(), *self._actions.values()))
        if known is None and not session.in_graph and count >= self._limits.topics:
            raise RemoteProtocolError(f"there are {self._limits.topics} services and actions already, the most allowed")
        table[name] = Provider(session, operation.type[:256])

    def _unadvertise(
        self, session: ClientSession, name: str, operation: UnadvertiseService | UnadvertiseAction
    ) -> None:
        is_service = isinstance(operation, UnadvertiseService)
        table = self._services if is_service else self._actions
        known = table.get(name)
        if known is None or known.session is not session:
            raise RemoteProtocolError("not advertised")
        del table[name]
        for identifier, call in list(self._calls.items()):
            if call.provider is session and call.name == name and call.is_goal is not is_service:
                del self._calls[identifier]
                self._fail(call, "it is no longer provided")

    def _call(self, session: ClientSession, name: str, operation: CallService, now_ns: int) -> None:
        caller = Caller(session, operation.id, operation.service, operation.fragment_size, operation.compression)
        try:
            builtin = self._builtins.get(name)
            if builtin is not None:
                self._call_builtin(builtin, caller, operation.args, now_ns)
                return
            provider = self._services.get(name)
            if session.role < Role.PUBLISH:
                raise RemoteProtocolError("services of other clients need the role publish")
            if provider is None:
                self._note_deadline(self.held.hold(session, name, operation, now_ns))
                return
            deadline_ns = now_ns + int((operation.timeout or self._limits.call_s) * NS_PER_S)
            identifier = self._open(caller, provider, name, deadline_ns)
            args = self._arguments(provider, "Request", operation.args, identifier)
        except BridgeError as error:
            caller.respond(f"{name}: {error}", False)
            return
        self._note_deadline(deadline_ns)
        limit = {"timeout": operation.timeout} if operation.timeout else {}
        send(provider.session, op="call_service", id=identifier, service=name, args=args, **limit)

    def _call_builtin(self, builtin: Builtin, caller: Caller, args: Any, now_ns: int) -> None:
        if caller.session.role < builtin.role:
            raise RemoteProtocolError(f"this needs the role {builtin.role.name.lower()}")
        args = checked_values(
            self._registry,
            "ros2",
            builtin.type,
            "Request",
            arguments_by_name(self._registry, builtin.type, "Request", args),
        )
        found = builtin.handler(args, caller.session.dialect)

        def respond(values: dict[str, Any]) -> None:
            """Answer in the caller's dialect and form."""
            plain = checked_values(
                self._registry, caller.session.dialect, builtin.type, "Response", values, caller.is_typed
            )
            caller.respond(plain, True)

        match found:
            case Forward():
                deadline_ns = now_ns + int(self._limits.call_s * NS_PER_S)
                self._ask(caller, found.request, deadline_ns, partial(answer_forwarded, found, caller, respond))
            case Survey():
                self._survey(found, caller, respond, now_ns)
            case _:
                respond(found)

    def _survey(self, survey: Survey, caller: Caller, respond: Callable[[dict[str, Any]], None], now_ns: int) -> None:
        requests = [request for request in survey.requests if self._is_provided(request)]
        answers = SurveyAnswers([each.service for each in requests], lambda good: respond(survey.read(good)))
        deadline_ns = now_ns + int(survey.timeout_s * NS_PER_S)
        for request in requests:
            self._ask(caller, request, deadline_ns, partial(answers.take, request.service))

    def _is_provided(self, request: NodeRequest) -> bool:
        """Return whether a node provides this, and not a client that has taken the node's name or another type."""
        provider = self._services.get(request.service)
        return provider is not None and provider.session.in_graph and provider.type == request.type

    def _ask(self, caller: Caller, request: NodeRequest, deadline_ns: int, on_end: Callable[[Any, bool], None]) -> None:
        """Call a node's service for one of the console."""
        service = request.service
        if not self._is_provided(request):
            raise RemoteProtocolError(f"{service}: {NOBODY}")
        provider = self._services[service]
        identifier = self._open(caller, provider, service, deadline_ns)
        args = self._arguments(provider, "Request", request.args, identifier)
        self._calls[identifier] = self._calls[identifier]._replace(on_end=on_end)
        self._note_deadline(deadline_ns)
        send(provider.session, op="call_service", id=identifier, service=service, args=args)

    def _respond(self, session: ClientSession, name: str, operation: ServiceResponse) -> None:
        identifier, call = self._find_call(session, name, operation.id)
        del self._calls[identifier]
        values, result = operation.values, operation.result
        if call.on_end is not None:
            try:
                values = (
                    checked_values(self._registry, "ros2", call.type, "Response", values)
                    if result
                    else f"{name}: {values}"
                )
            except BridgeError as error:
                values, result = f"{name}: {error}", False
            call.on_end(values, result)
            return
        # rosbridge_suite for ROS 1 uses the values alone, and its clients set no meaningful result.
        if isinstance(values, dict) and (values or result):
            try:
                values, result = self._checked(call, "Response", values), True
            except BridgeError as error:
                self._fail(call, f"the answer does not fit: {error}")
                raise
        elif result and values is None:
            values = {}
        call.caller.respond(values, result)

    def _goal(self, session: ClientSession, name: str, operation: SendActionGoal, now_ns: int) -> None:
        caller = Caller(session, operation.id, operation.action, operation.fragment_size, operation.compression)
        try:
            provider = self._actions.get(name)
            if provider is None:
                self._note_deadline(self.held.hold(session, name, operation, now_ns))
                return
            identifier = self._open(caller, provider, name, None, operation.feedback, True)
            args = self._arguments(provider, "Goal", operation.args, identifier)
        except BridgeError as error:
            caller.end(f"{name}: {error}", ABORTED, False)
            return
        kind = operation.action_type or provider.type
        send(
            provider.session, op="send_action_goal", id=identifier, action=name, action_type=kind, args=args,
            feedback=operation.feedback,
        )  # fmt: skip

    def _cancel(self, session: ClientSession, name: str, operation: CancelActionGoal) -> None:
        goals = {
            identifier: call
            for identifier, call in self._calls.items()
            if call.is_goal and call.caller.session is session and call.name == name
        }
        if operation.id is not None:
            goals = {identifier: call for identifier, call in goals.items() if call.caller.id == operation.id}
            if not goals:
                raise RemoteProtocolError("no such goal is pursued")
        for identifier, call in goals.items():
            send(call.provider, op="cancel_action_goal", action=name, id=identifier)

    def _feedback(self, session: ClientSession, name: str, operation: ActionFeedback) -> None:
        _, call = self._find_call(session, name, operation.id)
        values = self._checked(call, "Feedback", operation.values)
        if call.feedback:
            call.caller.send(op="action_feedback", action=call.caller.called, values=values)

    def _result(self, session: ClientSession, name: str, operation: ActionResult) -> None:
        identifier, call = self._find_call(session, name, operation.id)
        del self._calls[identifier]
        values = operation.values
        if isinstance(values, dict) and (values or operation.result):
            try:
                values = self._checked(call, "Result", values)
            except BridgeError as error:
                self._fail(call, f"the result does not fit: {error}")
                raise
        call.caller.end(values, operation.status, operation.result)

    def _open(
        self,
        caller: Caller,
        provider: Provider,
        name: str,
        deadline_ns: int | None,
        feedback: bool = False,
        is_goal: bool = False,
    ) -> str:
        most = caller.session.max_calls or self._limits.calls
        # One who asks several providers for one answer makes one call.
        callers = {id(call.caller) for call in self._calls.values() if call.caller.session is caller.session}
        if len(callers - {id(caller)}) >= most:
            raise RemoteProtocolError(f"{most} calls at a time are the most allowed")
        self._numbers += 1
        identifier = f"{'goal' if is_goal else 'call'}:{name}:{self._numbers}"
        self._calls[identifier] = OpenCall(
            caller=caller,
            provider=provider.session,
            name=name,
            type=provider.type,
            deadline_ns=deadline_ns,
            feedback=feedback,
            is_goal=is_goal,
        )
        return identifier

    def _arguments(self, provider: Provider, part: str, args: Any, identifier: str) -> Any:
        try:
            return checked_values(
                self._registry,
                provider.session.dialect,
                provider.type,
                part,
                arguments_by_name(self._registry, provider.type, part, args),
            )
        except BridgeError:
            del self._calls[identifier]
            raise

    def _note_deadline(self, deadline_ns: int) -> None:
        if self._next_deadline_ns is None or deadline_ns < self._next_deadline_ns:
            self._next_deadline_ns = deadline_ns

    def _find_call(self, session: ClientSession, name: str, identifier: Id) -> tuple[str, OpenCall]:
        """Return the open call that a provider refers to."""
        call = self._calls.get(identifier) if isinstance(identifier, str) else None
        if call is None or call.provider is not session or call.name != name:
            raise RemoteProtocolError("nobody waits for this: no call has this id")
        assert isinstance(identifier, str)
        return identifier, call

    def _fail(self, call: OpenCall, reason: str) -> None:
        reason = f"{call.name}: {reason}"
        if call.is_goal:
            call.caller.end(reason, ABORTED, False)
        elif call.on_end is not None:
            call.on_end(reason, False)
        else:
            call.caller.respond(reason, False)

    def _checked(self, call: OpenCall, part: str, values: Any) -> Any:
        return checked_values(
            self._registry, call.caller.session.dialect, call.type, part, values, call.caller.is_typed
        )
