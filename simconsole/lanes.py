"""Machine code that steps LANES vehicles at once, made from the same kernel as a single vehicle's (shell: a compiler).

No cache: the compiler needs half a second. Nothing is contracted or reordered, so a lane gives the bits of the plain
function on every processor.
"""

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any, Final, NamedTuple

from simconsole.lane_code import write_call
from simconsole.lane_values import LANES, Columns, LaneWriter

HOST: Final = ""
"""The processor that runs this program, with all it can do."""

_NAME: Final = "step"


class LaneStep(NamedTuple):
    """One compiled step. `run(rows, parameters, substeps, blocks)` takes the addresses of aligned float64 arrays."""

    run: Callable[[int, int, int, int], None]
    assembly: str
    engine: Any  # owns the machine code


@cache
def lane_step(
    step: Callable[..., Any], first: int, width: int, parameters: int, shared: bool, processor: str = HOST
) -> LaneStep:
    """Return a platform's step for blocks of LANES vehicles.

    Args:
        step: the platform's kernel (vehicle/platform.py).
        first: the first column of a row that the arrays hold; the step reads and writes none before it.
        width: columns that they hold.
        parameters: length of one vehicle's parameter row.
        shared: all vehicles have the same parameter row, `parameters` long; otherwise blocks as of the rows.
        processor: a name that LLVM knows, to make code for another processor of this machine's kind.

    Raises:
        TypeError: the kernel does something that lanes cannot.
    """
    from llvmlite import binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    module = llvm.parse_assembly(_code(step, first, width, parameters, shared))
    module.verify()
    features = llvm.get_host_cpu_features().flatten() if processor == HOST else ""
    target = llvm.Target.from_default_triple().create_target_machine(
        cpu=processor or llvm.get_host_cpu_name(), features=features, opt=3
    )
    options = llvm.create_pipeline_tuning_options(speed_level=3)
    passes = llvm.create_pass_builder(target, options)
    passes.getModulePassManager().run(module, passes)
    assembly = target.emit_assembly(module)
    engine = llvm.create_mcjit_compiler(module, target)
    engine.finalize_object()
    kind = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64, ctypes.c_int64)
    return LaneStep(kind(engine.get_function_address(_NAME)), assembly, engine)


def _code(step: Callable[..., Any], first: int, width: int, parameters: int, shared: bool) -> str:
    """Return the text of a function that steps every block, one after the other."""
    from llvmlite import ir

    module = ir.Module()
    numbers, whole = ir.DoubleType().as_pointer(), ir.IntType(64)
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), [numbers, numbers, whole, whole]), _NAME)
    rows, constants, substeps, blocks = function.args
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    lanes = LaneWriter(builder, module)

    def block(_: dict[str, Any], number: Any) -> dict[str, Any]:
        at = builder.gep(rows, [builder.mul(number, ir.Constant(whole, width * LANES))])
        row = Columns(at, first, LANES)
        own = builder.gep(constants, [builder.mul(number, ir.Constant(whole, parameters * LANES))])
        write_call(
            lanes,
            step,
            (row, row, Columns(constants, 0, 1, True) if shared else Columns(own, 0, LANES, True), substeps),
        )
        return {}

    lanes.count({}, (), block, blocks)
    builder.ret_void()
    return str(module)
