"""numba extensions: the kernel primitives that are no kernels themselves, and a compiler for what is inlined."""

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

from simconsole.values.kernels import foreseen, forget
from simconsole.values.layout import Part, read, write


def teach() -> None:
    """Register `kernels.forget`, `kernels.foreseen`, `layout.read` and `layout.write` with numba; once in a process."""
    _teach_empty(forget, "~{memory}")
    _teach_empty(foreseen, "")
    _teach_parts()


@cache
def compiler_of_inlined() -> Any:
    """Return numba's compiler (`pipeline_class`) for functions that stand in their callers' code and nowhere else.

    numba optimises each function together with all that it calls, and makes machine code of it. Where all calls are
    inlined, a function is optimised again in each caller, at each level up: that took half of a first drive's time to
    compile. Here only the outermost function is optimised, once, with all that it has taken in.
    """
    codegen: Any = import_module("numba.core.codegen")
    compiler: Any = import_module("numba.core.compiler")

    class Unbound:
        """No machine code, so no environment to bind to it."""

        def set_env(self, name: str, environment: Any) -> None:
            pass

    class InlinedLibrary(codegen.JITCodeLibrary):  # type: ignore[misc]  # numba is not typed
        """The code of one function, to be linked into its callers."""

        codegen = Unbound()

        def _optimize_final_module(self) -> None:
            pass

        def _finalize_final_module(self) -> None:
            self._finalized = True

        def get_pointer_to_function(self, name: str) -> int:
            return 0

    class InlinedCompiler(compiler.Compiler):  # type: ignore[misc]
        def compile_extra(self, function: Any) -> Any:
            self.state.library = InlinedLibrary(self.state.targetctx.codegen(), function.__qualname__)
            return super().compile_extra(function)

    return InlinedCompiler


def size_of(kind: Any) -> int:
    """Return how many bytes a value of a numba type takes in memory."""
    target: Any = import_module("numba.core.registry").cpu_target.target_context
    return int(target.get_abi_sizeof(target.get_value_type(kind)))


def memory_of(kind: Any) -> tuple[Any, Any]:
    """Return two functions for compiled code: they write a value of a numba type at an address, and read it there."""
    types: Any = import_module("numba.core.types")
    intrinsic: Any = import_module("numba.extending").intrinsic

    def place(context: Any, builder: Any, address: Any) -> Any:
        return builder.inttoptr(address, context.get_value_type(kind).as_pointer())

    @intrinsic  # type: ignore[untyped-decorator]
    def keep(_typing: Any, address: Any, value: Any) -> Any:
        def lower(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
            builder.store(arguments[1], place(context, builder, arguments[0]))
            return context.get_dummy_value()

        return (types.none(address, value), lower) if value == kind else None

    @intrinsic  # type: ignore[untyped-decorator]
    def kept(_typing: Any, address: Any) -> Any:
        def lower(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
            return builder.load(place(context, builder, arguments[0]))

        return kind(address), lower

    return keep, kept


def _teach_empty(function: Callable[[], None], changes: str) -> None:
    """Compile a function to a barrier: an empty instruction that the compiler must leave where it is.

    Args:
        function: of no arguments.
        changes: what the compiler must assume it to change, as LLVM writes it.
    """
    types: Any = import_module("numba.core.types")
    extending: Any = import_module("numba.extending")
    ir: Any = import_module("llvmlite.ir")

    def lower(context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        builder.asm(ir.FunctionType(ir.VoidType(), []), "", changes, [], True)
        return context.get_dummy_value()

    extending.type_callable(function)(lambda _context: lambda: types.none)
    extending.lower_builtin(function)(lower)


def _teach_parts() -> None:
    """Plain loads into tuples, and plain stores: they compile faster than slices."""
    types: Any = import_module("numba.core.types")
    models: Any = import_module("numba.core.datamodel.models")
    imputils: Any = import_module("numba.core.imputils")
    extending: Any = import_module("numba.extending")

    class PartType(types.Type):  # type: ignore[misc]  # numba is not typed
        """The numba type of one part: a constant that takes no memory at run time."""

        def __init__(self, part: Part[Any]) -> None:
            self.part = part
            super().__init__(name=f"Part({part.record.__module__}.{part.record.__qualname__}, {part.start})")

    def record_type(part: Part[Any]) -> Any:
        fields = [record_type(inner) for inner in part.inner] or [types.float64] * part.width
        return types.BaseTuple.from_types(fields, part.record)

    def is_vector(row: Any) -> bool:
        return isinstance(row, types.Array) and (row.dtype, row.ndim, row.layout) == (types.float64, 1, "C")

    extending.typeof_impl.register(Part)(lambda part, _context: PartType(part))
    extending.register_model(PartType)(models.OpaqueModel)
    imputils.lower_constant(PartType)(lambda context, *_: context.get_dummy_value())

    @extending.type_callable(read)  # type: ignore[untyped-decorator]
    def type_read(_context: Any) -> Any:
        def typer(row: Any, part: Any) -> Any:
            return record_type(part.part) if is_vector(row) and isinstance(part, PartType) else None

        return typer

    @extending.type_callable(write)  # type: ignore[untyped-decorator]
    def type_write(_context: Any) -> Any:
        def typer(row: Any, part: Any, record: Any) -> Any:
            fits = is_vector(row) and isinstance(part, PartType) and isinstance(record, types.BaseNamedTuple)
            return types.none if fits and record.instance_class is part.part.record else None

        return typer

    @extending.lower_builtin(read, types.Array, PartType)  # type: ignore[untyped-decorator]
    def lower_read(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = signature.args[0]
        data = context.make_array(array)(context, builder, arguments[0]).data

        def load(part: Part[Any]) -> Any:
            values = [load(inner) for inner in part.inner] or [
                context.unpack_value(builder, array.dtype, builder.gep(data, [context.get_constant(types.intp, at)]))
                for at in range(part.start, part.stop)
            ]
            return context.make_tuple(builder, record_type(part), values)

        return load(signature.args[1].part)

    @extending.lower_builtin(write, types.Array, PartType, types.BaseNamedTuple)  # type: ignore[untyped-decorator]
    def lower_write(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array, part, record = signature.args
        data = context.make_array(array)(context, builder, arguments[0]).data

        def floats(kind: Any, value: Any) -> Any:
            if isinstance(kind, types.BaseTuple):
                for index, field in enumerate(kind):
                    yield from floats(field, builder.extract_value(value, index))
            else:
                yield context.cast(builder, value, kind, array.dtype)

        for at, value in enumerate(floats(record, arguments[2]), part.part.start):
            context.pack_value(builder, array.dtype, value, builder.gep(data, [context.get_constant(types.intp, at)]))
        return context.get_dummy_value()
