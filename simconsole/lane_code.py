"""Kernels as vector code: one value of a kernel becomes LANES of them, every branch a selection.

The source text of a kernel is walked once, as an interpreter would, with vectors of LLVM for its floats. Both sides of
an `if` are computed and each lane keeps what its own condition chooses (a long side that no lane takes is jumped over);
an early `return` ends only the lanes that take it. Every operation is IEEE 754 in the order in which the text has it,
so a lane holds the bits that the plain function gives. Whatever the walk does not know is refused; nothing is guessed.
"""

import ast
import inspect
import math
import textwrap
from collections.abc import Callable, Sequence
from functools import cache
from types import FunctionType
from typing import Final, NamedTuple

from simconsole.kernels import forget, is_kernel, put, take
from simconsole.lane_values import LaneWriter, Names, Value

HEAVY: Final = 11
"""Operations from which one side of a choice is worth a jump over it: measured with benchmarks/vehicle_step.py."""

SLOW: Final = 10
"""Further operations in whose time a division or a root is done."""


class Branch(NamedTuple):
    """What a block of statements leaves: its names, and the lanes that have not returned."""

    names: Names
    live: Value


def write_call(
    lanes: LaneWriter, function: Callable[..., Value], arguments: Sequence[Value], keywords: Names | None = None
) -> Value:
    """Write a call of a kernel, in line, and return what it returns.

    Raises:
        TypeError: `function` is not a kernel, or does what lanes cannot.
    """
    if not is_kernel(function):
        raise TypeError(f"{function.__qualname__} is not a kernel")
    bound = inspect.signature(function).bind(*arguments, **(keywords or {}))
    bound.apply_defaults()
    returned: list[tuple[Value, Value]] = []
    _Walk(lanes, function, returned).block(_body(function), dict(bound.arguments), True)
    if not returned:
        return None
    result = returned[-1][1]
    for taken, value in reversed(returned[:-1]):
        result = lanes.select(taken, value, result)
    return result


class _Walk:
    """The statements of one kernel."""

    def __init__(self, lanes: LaneWriter, function: Callable[..., Value], returned: list[tuple[Value, Value]]) -> None:
        self._lanes = lanes
        self._function = function
        self._globals = function.__globals__
        self._returned = returned

    def block(self, statements: Sequence[ast.stmt], names: Names, live: Value) -> Branch:
        for statement in statements:
            if live is False:
                break
            names, live = self._statement(statement, names, live)
        return Branch(names, live)

    def _statement(self, statement: ast.stmt, names: Names, live: Value) -> Branch:
        match statement:
            case ast.Return(value=value):
                self._returned.append((live, None if value is None else self._value(value, names)))
                return Branch(names, False)
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                return Branch({**names, name: self._value(value, names)}, live)
            case ast.Assign(targets=[ast.Tuple(elts=parts)], value=value):
                values = self._value(value, names)
                found = {part.id: one for part, one in zip(parts, values, strict=True) if isinstance(part, ast.Name)}
                return Branch({**names, **found}, live)
            case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
                return Branch({**names, name: self._value(value, names)}, live)
            case ast.AugAssign(target=ast.Name(id=name), op=op, value=value):
                total = self._lanes.arithmetic(type(op), names[name], self._value(value, names))
                return Branch({**names, name: total}, live)
            case ast.If(test=test, body=body, orelse=orelse):
                return self._choice(self._lanes.mask(self._value(test, names)), body, orelse, names, live)
            case ast.For() | ast.While():
                return Branch(self._loop(statement, names, live), live)
            case ast.Expr(value=value):
                if not isinstance(value, ast.Constant):
                    self._value(value, names)
                return Branch(names, live)
        raise self._unknown(statement)

    def _choice(self, test: Value, body: list[ast.stmt], orelse: list[ast.stmt], names: Names, live: Value) -> Branch:
        lanes = self._lanes
        if isinstance(test, bool):
            return self.block(body if test else orelse, names, live)
        lanes.conditional(1)
        yes = self._side(lanes.both(live, test), body, names)
        no = self._side(lanes.both(live, lanes.opposite(test)), orelse, names)
        lanes.conditional(-1)
        if yes.live is False or no.live is False:
            return no if yes.live is False else yes
        merged = {**yes.names, **no.names}
        for name in yes.names.keys() & no.names.keys():
            merged[name] = lanes.select(test, yes.names[name], no.names[name])
        return Branch(merged, lanes.either(yes.live, no.live))

    def _side(self, live: Value, statements: list[ast.stmt], names: Names) -> Branch:
        """Return one side of a choice; a long one is jumped over where no lane takes it."""
        if sum(_weight(statement, self._globals) for statement in statements) < HEAVY:
            return self.block(statements, dict(names), live)
        kept = len(self._returned)

        def compute() -> Value:
            branch = self.block(statements, dict(names), live)
            changed = {name: value for name, value in branch.names.items() if names.get(name) is not value}
            returned = tuple(self._returned[kept:])
            del self._returned[kept:]
            return tuple(changed), tuple(changed.values()), branch.live, returned

        changed, values, still, returned = self._lanes.guarded(live, compute)
        self._returned.extend(returned)
        return Branch({**names, **dict(zip(changed, values, strict=True))}, still)

    def _loop(self, loop: ast.For | ast.While, names: Names, live: Value) -> Names:
        """Return the names after a loop. A lane ends it for good with its condition: no return, break or continue."""
        inside = [node for statement in loop.body for node in ast.walk(statement)]
        if loop.orelse or any(isinstance(node, ast.Return | ast.Break | ast.Continue) for node in inside):
            raise self._unknown(loop)
        changed = [node.id for node in inside if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)]
        lanes = self._lanes
        if isinstance(loop, ast.While):
            test = loop.test

            def again(seen: Names) -> Value:
                return lanes.both(live, self._value(test, seen))

            def turn(seen: Names, going: Value) -> Names:
                lanes.conditional(1)
                done = self.block(loop.body, dict(seen), going).names
                lanes.conditional(-1)
                return done

            return lanes.repeat(names, changed, turn, again)
        match loop:
            case ast.For(target=ast.Name(id=index), iter=ast.Call(func=ast.Name(id="range"), args=[times])):
                turns = self._value(times, names)
                if isinstance(turns, int):
                    for number in range(turns):
                        names = self.block(loop.body, {**names, index: number}, live).names
                    return names

                def counted(seen: Names, _: Value) -> Names:
                    return self.block(loop.body, dict(seen), True).names

                return lanes.count(names, changed, counted, turns)
        raise self._unknown(loop)

    def _value(self, node: ast.expr, names: Names) -> Value:
        lanes = self._lanes
        match node:
            case ast.Constant(value=value):
                return value
            case ast.Name(id=name):
                return names[name] if name in names else self._global(name)
            case ast.Attribute(value=of, attr=attr):
                return getattr(self._value(of, names), attr)
            case ast.BinOp(left=left, op=op, right=right):
                return lanes.arithmetic(type(op), self._value(left, names), self._value(right, names))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return lanes.negative(self._value(operand, names))
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return lanes.opposite(self._value(operand, names))
            case ast.BoolOp(op=op, values=parts):
                join = lanes.both if isinstance(op, ast.And) else lanes.either
                result: Value = isinstance(op, ast.And)
                for part in parts:
                    result = join(result, self._value(part, names))
                return result
            case ast.Compare(left=left, ops=ops, comparators=others):
                values = [self._value(part, names) for part in (left, *others)]
                result = True
                for sign, one, other in zip(ops, values, values[1:], strict=False):
                    result = lanes.both(result, lanes.comparison(type(sign), one, other))
                return result
            case ast.IfExp(test=test, body=body, orelse=orelse):
                chosen = lanes.mask(self._value(test, names))
                if isinstance(chosen, bool):
                    return self._value(body if chosen else orelse, names)
                yes = self._part(chosen, body, names)
                return lanes.select(chosen, yes, self._part(lanes.opposite(chosen), orelse, names))
            case ast.Tuple(elts=parts):
                return tuple(self._value(part, names) for part in parts)
            case ast.Call():
                return self._call(node, names)
        raise self._unknown(node)

    def _part(self, wanted: Value, node: ast.expr, names: Names) -> Value:
        """Return one side of a conditional expression."""
        if _weight(node, self._globals) < HEAVY:
            return self._value(node, names)
        return self._lanes.guarded(wanted, lambda: self._value(node, names))

    def _call(self, node: ast.Call, names: Names) -> Value:
        lanes = self._lanes
        function = self._value(node.func, names)
        arguments: list[Value] = []
        for part in node.args:
            if isinstance(part, ast.Starred):
                arguments.extend(self._value(part.value, names))
            else:
                arguments.append(self._value(part, names))
        keywords = {str(word.arg): self._value(word.value, names) for word in node.keywords}
        if function is take:
            row, start, count = arguments
            return tuple(lanes.load(row, column) for column in range(start, start + count))
        if function is forget:
            return None
        if function is put:
            row, start, values = arguments
            for column, value in enumerate(values, start):
                lanes.store(row, column, value)
            return None
        if function is math.sqrt:
            return lanes.intrinsic("sqrt", arguments[0])
        if function is abs:
            (value,) = arguments
            return abs(value) if isinstance(value, int | float) else lanes.intrinsic("fabs", value)
        if function is float:
            return float(arguments[0]) if isinstance(arguments[0], int | float) else lanes.vector(arguments[0])
        if isinstance(function, type) and issubclass(function, tuple):
            return function(*arguments, **keywords)
        if is_kernel(function):
            return write_call(lanes, function, arguments, keywords)
        raise self._unknown(node)

    def _global(self, name: str) -> Value:
        if name in self._globals:
            return self._globals[name]
        known = {"abs": abs, "float": float}
        if name not in known:
            raise self._unknown(ast.Name(id=name))
        return known[name]

    def _unknown(self, node: ast.AST) -> TypeError:
        where = f"{self._function.__module__}.{self._function.__qualname__}"
        return TypeError(f"{where}: lanes have no way for `{ast.unparse(node)}`")


@cache
def _weight_of(function: object) -> int:
    if not isinstance(function, FunctionType) or not is_kernel(function):
        return 0
    return sum(_weight(statement, function.__globals__) for statement in _body(function))


def _weight(node: ast.AST, names: Names) -> int:
    """Return how many operations a statement or expression has, those of the kernels that it calls included."""
    weight = 0
    for part in ast.walk(node):
        weight += isinstance(part, ast.BinOp | ast.Compare)
        if isinstance(part, ast.BinOp) and isinstance(part.op, ast.Div):
            weight += SLOW
        if isinstance(part, ast.Call) and isinstance(part.func, ast.Name):
            function = names.get(part.func.id)
            weight += SLOW if function is math.sqrt else _weight_of(function)
    return weight


@cache
def _body(function: Callable[..., Value]) -> list[ast.stmt]:
    (definition,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
    assert isinstance(definition, ast.FunctionDef)
    return definition.body
