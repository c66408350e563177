"""What the kernels need besides + - * /, for one number or for eight lanes.

Each is one or two instructions of LLVM, for a vector as for a scalar.
"""

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

from uvms_dynamics.kernels.numba_internals.lanes import LanesType, is_table, lanes
from uvms_dynamics.kernels.numba_internals.parts import intrinsic

_MANTISSA_BITS, _EXPONENT_BIAS = 52, 1023.0
ROUND = 1.5 * 2.0**_MANTISSA_BITS
"""A float64 of this size has no room for a fraction: adding it and taking it away rounds."""


def _generic(args: tuple[types.Type, ...], emit: Callable) -> Any:
    """Signature and code of an intrinsic whose arguments and result are numbers or lanes."""
    kind = lanes if any(isinstance(each, LanesType) for each in args) else types.float64

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        same = [
            context.cast(builder, value, given, kind)
            for value, given in zip(values, signature.args, strict=True)
        ]
        return emit(builder, *same)

    return kind(*args), generate


def _call(name: str) -> Callable:
    """An LLVM intrinsic, such as llvm.sqrt.f64 or llvm.sqrt.v8f64."""

    def emit(builder: Any, *values: Any) -> Any:
        kind = values[0].type
        suffix = f"v{kind.count}f64" if isinstance(kind, ir.VectorType) else "f64"
        signature = ir.FunctionType(kind, [kind] * len(values))
        full = f"llvm.{name}.{suffix}"
        function = cgutils.get_or_insert_function(builder.module, signature, full)
        return builder.call(function, values)

    return emit


def _select(sign: str) -> Callable:
    def emit(builder: Any, x: Any, y: Any) -> Any:
        return builder.select(builder.fcmp_ordered(sign, x, y), x, y)

    return emit


@intrinsic
def zero_like(_context, x):
    """Zero of the type of x."""
    return _generic((x,), lambda _builder, value: ir.Constant(value.type, None))


@intrinsic
def sqrt(_context, x):
    """Square root."""
    return _generic((x,), _call("sqrt"))


@intrinsic
def fabs(_context, x):
    """|x|."""
    return _generic((x,), _call("fabs"))


@intrinsic
def copysign(_context, x, y):
    """|x| with the sign of y."""
    return _generic((x, y), _call("copysign"))


@intrinsic
def maximum(_context, x, y):
    """The larger of two; y where x is NaN."""
    return _generic((x, y), _select(">"))


@intrinsic
def minimum(_context, x, y):
    """The smaller of two; y where x is NaN."""
    return _generic((x, y), _select("<"))


@intrinsic
def power_of_two(_context, k):
    """2^k of a whole number -1000 < k < 1000, by way of a float64's exponent."""

    def emit(builder: Any, value: Any) -> Any:
        if isinstance(value.type, ir.VectorType):
            count = value.type.count
            whole = ir.VectorType(ir.IntType(64), count)
            shift = ir.Constant(whole, [_MANTISSA_BITS] * count)
            bias = ir.Constant(value.type, [ROUND + _EXPONENT_BIAS] * count)
        else:
            whole = ir.IntType(64)
            shift = ir.Constant(whole, _MANTISSA_BITS)
            bias = ir.Constant(value.type, ROUND + _EXPONENT_BIAS)
        bits = builder.bitcast(builder.fadd(value, bias), whole)
        return builder.bitcast(builder.shl(bits, shift), value.type)

    return _generic((k,), emit)


@intrinsic
def read(_context, table, k):
    """Number k of a contiguous table, counted through its rows."""
    if not is_table(table):
        return None

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        array = context.make_array(signature.args[0])(context, builder, args[0])
        return builder.load(builder.gep(array.data, [args[1]]))

    return types.float64(table, types.intp), generate


@intrinsic
def write(_context, table, k, number):
    """Write number k of a contiguous table, counted through its rows."""
    if not is_table(table):
        return None

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        array = context.make_array(signature.args[0])(context, builder, args[0])
        builder.store(args[2], builder.gep(array.data, [args[1]]))
        return context.get_dummy_value()

    return types.void(table, types.intp, types.float64), generate
