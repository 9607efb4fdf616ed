"""Vectors of LLVM for the floats of a kernel: values, choices and loops of LANES rows at once (llvmlite, on demand)."""

import ast
import operator
from collections.abc import Callable, Sequence
from typing import Any, Final, NamedTuple

LANES: Final = 8
"""Doubles in one vector: the width of AVX-512; narrower machines take two or four operations for one."""

Value = Any
"""A Python number (the same in every lane), a vector of doubles, a mask (vector of bits), or a tuple of values."""
Names = dict[str, Value]

_ORDERED: Final[dict[type[ast.AST], str]] = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "=="}
_PLAIN: Final[dict[type[ast.AST], Callable[..., Any]]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_ARITHMETIC: Final[dict[type[ast.AST], str]] = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}


class Columns(NamedTuple):
    """Where the columns of LANES rows lie: column c of lane k at `pointer[(c - first) * stride + k]`."""

    pointer: Any
    first: int
    stride: int  # LANES, or 1 where all lanes share one row
    constant: bool = False  # nothing is written here: a column is read where it is needed, each time anew


class Constant:
    """A column of constants that has not been read yet.

    There are some two hundred of them and 32 registers: read in advance, each would be stored and read again.
    """

    def __init__(self, row: Columns, column: int) -> None:
        self.row = row
        self.column = column


class LaneWriter:
    """Writes operations on lanes at the builder's place."""

    def __init__(self, builder: Any, module: Any) -> None:
        from llvmlite import ir

        self._ir = ir
        self._builder = builder
        self._module = module
        self._doubles = ir.VectorType(ir.DoubleType(), LANES)
        self._bits = ir.VectorType(ir.IntType(1), LANES)
        self._conditions = 0  # around the present statement: nothing may be stored inside one
        self._zero: Any = None  # of the present turn: 0, but the compiler does not know

    def load(self, row: Columns, column: int) -> Value:
        """Return one column."""
        return Constant(row, column) if row.constant else self._read(row, column)

    def _read(self, row: Columns, column: int) -> Any:
        ir, builder = self._ir, self._builder
        pointer = builder.gep(row.pointer, [self._zero]) if row.constant and self._zero is not None else row.pointer
        at = builder.gep(pointer, [ir.Constant(ir.IntType(64), (column - row.first) * row.stride)])
        if row.stride == 1:
            one = builder.load(at)
            empty = ir.Constant(self._doubles, ir.Undefined)
            first = builder.insert_element(empty, one, ir.Constant(ir.IntType(32), 0))
            return builder.shuffle_vector(first, empty, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))
        return builder.load(builder.bitcast(at, self._doubles.as_pointer()), align=8)

    def store(self, row: Columns, column: int, value: Value) -> None:
        """Write one column of every lane.

        Raises:
            TypeError: inside a condition, or into a row that lanes share.
        """
        if self._conditions or row.stride == 1:
            raise TypeError("a row can be written only outside every condition, and only where each lane has its own")
        ir, builder = self._ir, self._builder
        at = builder.gep(row.pointer, [ir.Constant(ir.IntType(64), (column - row.first) * row.stride)])
        builder.store(self.vector(value), builder.bitcast(at, self._doubles.as_pointer()), align=8)

    def vector(self, value: Value) -> Any:
        """Return a number, a vector or a mask as a vector of doubles."""
        if isinstance(value, bool | int | float):
            return self._ir.Constant(self._doubles, [float(value)] * LANES)
        if isinstance(value, Constant):
            return self._read(value.row, value.column)
        return self.select(value, 1.0, 0.0) if value.type == self._bits else value

    def mask(self, value: Value) -> Any:
        """Return the truth of a value: a bool where all lanes are known to agree, else a mask."""
        if isinstance(value, bool | int | float):
            return bool(value)
        if getattr(value, "type", None) == self._bits:
            return value
        return self._builder.fcmp_unordered("!=", self.vector(value), self.vector(0.0))

    def select(self, condition: Value, chosen: Value, other: Value) -> Value:
        """Return `chosen` in the lanes where `condition` holds."""
        condition = self.mask(condition)
        if isinstance(condition, bool):
            return chosen if condition else other
        if chosen is other:
            return chosen
        if isinstance(chosen, tuple):
            pairs = zip(chosen, other, strict=True)
            parts = [self.select(condition, a, b) for a, b in pairs]
            return type(chosen)(*parts) if hasattr(chosen, "_fields") else tuple(parts)
        if self._is_truth(chosen) and self._is_truth(other):
            return self._builder.select(condition, self._as_bits(chosen), self._as_bits(other))
        return self._builder.select(condition, self.vector(chosen), self.vector(other))

    def both(self, one: Value, other: Value) -> Value:
        """Return the mask of lanes where both hold."""
        one, other = self.mask(one), self.mask(other)
        if isinstance(one, bool):
            return other if one else False
        if isinstance(other, bool):
            return one if other else False
        return self._builder.and_(one, other)

    def either(self, one: Value, other: Value) -> Value:
        """Return the mask of lanes where one holds at least."""
        one, other = self.mask(one), self.mask(other)
        if isinstance(one, bool):
            return True if one else other
        if isinstance(other, bool):
            return True if other else one
        return self._builder.or_(one, other)

    def opposite(self, value: Value) -> Value:
        """Return the mask of lanes where it does not hold."""
        value = self.mask(value)
        return not value if isinstance(value, bool) else self._builder.not_(value)

    def arithmetic(self, kind: type[ast.AST], one: Value, other: Value) -> Value:
        """Return one operation of + - * /.

        Raises:
            TypeError: another operation.
        """
        if kind not in _ARITHMETIC:
            raise TypeError(f"lanes have no {kind.__name__}")
        if isinstance(one, int | float) and isinstance(other, int | float):
            return _PLAIN[kind](one, other)
        return getattr(self._builder, _ARITHMETIC[kind])(self.vector(one), self.vector(other))

    def comparison(self, kind: type[ast.AST], one: Value, other: Value) -> Value:
        """Return one comparison.

        Raises:
            TypeError: not of numbers.
        """
        if kind not in _PLAIN:
            raise TypeError(f"lanes have no {kind.__name__}")
        if isinstance(one, int | float) and isinstance(other, int | float):
            return _PLAIN[kind](one, other)
        if kind is ast.NotEq:
            return self._builder.fcmp_unordered("!=", self.vector(one), self.vector(other))
        return self._builder.fcmp_ordered(_ORDERED[kind], self.vector(one), self.vector(other))

    def negative(self, value: Value) -> Value:
        """Return -value."""
        return -value if isinstance(value, int | float) else self._builder.fneg(self.vector(value))

    def intrinsic(self, name: str, value: Value) -> Value:
        """Return `sqrt` or `fabs`, both exact by IEEE 754."""
        full = f"llvm.{name}.v{LANES}f64"
        known = self._module.globals.get(full)
        if known is None:
            kind = self._ir.FunctionType(self._doubles, [self._doubles])
            known = self._ir.Function(self._module, kind, full)
        return self._builder.call(known, [self.vector(value)])

    def repeat(self, names: Names, changed: Sequence[str], turn: Callable[[Names, Any], Names], again: Any) -> Names:
        """Write a loop that runs until `again` (names -> mask or one bit) holds in no lane; others rest."""
        builder = self._builder
        kept = {name: names[name] for name in changed if name in names}
        places = {name: self._places(value) for name, value in kept.items()}
        for name, value in kept.items():
            self._keep(places[name], value)
        head, body, after = (builder.append_basic_block(word) for word in ("head", "body", "after"))
        builder.branch(head)
        builder.position_at_end(head)
        seen = {**names, **{name: self._kept(places[name], value) for name, value in kept.items()}}
        going = again(seen)
        builder.cbranch(self._any(going), body, after)
        builder.position_at_end(body)
        done = turn(seen, going)
        for name in kept:
            lanes = going if getattr(going, "type", None) == self._bits else True
            self._keep(places[name], self.select(lanes, done[name], seen[name]))
        builder.branch(head)
        builder.position_at_end(after)
        return seen

    def count(self, names: Names, changed: Sequence[str], turn: Callable[[Names, Any], Names], times: Any) -> Names:
        """Write a loop of `times` (a 64-bit integer of LLVM) turns in all lanes; each gets the names and its number."""
        ir, builder = self._ir, self._builder
        whole = ir.IntType(64)
        place = self._place(whole)
        builder.store(ir.Constant(whole, 0), place)

        def again(_: Names) -> Any:
            return builder.icmp_signed("<", builder.load(place), times)

        def counted(seen: Names, _: Any) -> Names:
            number = builder.load(place)
            builder.store(builder.add(number, ir.Constant(whole, 1)), place)
            before, self._zero = self._zero, self._unknown_zero()
            done = turn(seen, number)
            self._zero = before
            return done

        return self.repeat(names, changed, counted, again)

    def _unknown_zero(self) -> Any:
        """Return 0 by an empty piece of assembly: an address with it in is another one in each turn of a loop.

        Otherwise the compiler reads all constants before the loop, and has no registers to keep them in.
        """
        whole = self._ir.IntType(64)
        kind = self._ir.FunctionType(whole, [whole])
        return self._builder.asm(kind, "", "=r,0", [self._ir.Constant(whole, 0)], True)

    def guarded(self, wanted: Value, compute: Callable[[], Value]) -> Value:
        """Write `compute` so that it is jumped over where no lane wants it; its values are then zeros nobody sees."""
        if getattr(wanted, "type", None) != self._bits:
            return compute()
        builder = self._builder
        head = builder.block
        inside, after = builder.append_basic_block("inside"), builder.append_basic_block("after")
        builder.cbranch(self._any(wanted), inside, after)
        builder.position_at_end(inside)
        value = compute()
        tail = builder.block
        builder.branch(after)
        builder.position_at_end(after)
        return self._joined(value, head, tail)

    def conditional(self, change: int) -> None:
        """Enter (1) or leave (-1) a condition."""
        self._conditions += change

    def _joined(self, value: Value, head: Any, tail: Any) -> Value:
        """Return what was computed in `tail` as seen after the jump from `head` too."""
        if isinstance(value, tuple):
            parts = [self._joined(part, head, tail) for part in value]
            return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
        if value is None or isinstance(value, bool | int | float | str | Constant):
            return value
        joined = self._builder.phi(value.type)
        joined.add_incoming(value, tail)
        joined.add_incoming(self._ir.Constant(value.type, None), head)
        return joined

    def _any(self, going: Any) -> Any:
        if getattr(going, "type", None) != self._bits:
            return going
        ir = self._ir
        whole = self._builder.bitcast(going, ir.IntType(LANES))
        return self._builder.icmp_unsigned("!=", whole, ir.Constant(ir.IntType(LANES), 0))

    def _is_truth(self, value: Value) -> bool:
        return isinstance(value, bool) or getattr(value, "type", None) == self._bits

    def _as_bits(self, value: Value) -> Any:
        return self._ir.Constant(self._bits, [int(value)] * LANES) if isinstance(value, bool) else value

    def _place(self, kind: Any) -> Any:
        with self._builder.goto_entry_block():
            return self._builder.alloca(kind)

    def _places(self, value: Value) -> Any:
        if isinstance(value, tuple):
            return [self._places(part) for part in value]
        return self._place(self._bits if self._is_truth(value) else self._doubles)

    def _keep(self, places: Any, value: Value) -> None:
        if isinstance(value, tuple):
            for place, part in zip(places, value, strict=True):
                self._keep(place, part)
        else:
            self._builder.store(self._as_bits(value) if self._is_truth(value) else self.vector(value), places)

    def _kept(self, places: Any, like: Value) -> Value:
        if isinstance(like, tuple):
            parts = [self._kept(place, part) for place, part in zip(places, like, strict=True)]
            return type(like)(*parts) if hasattr(like, "_fields") else tuple(parts)
        return self._builder.load(places)
