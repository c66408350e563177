"""Eight numbers in the place of one: a numba type, so that one source serves both.

A kernel that is called with `Lanes` works on eight independent simulations at once: + - * / and the
functions of `primitives` act lane by lane, and numbers beside them are broadcast to all eight. LLVM
maps the eight to whatever vectors the processor has. Tables of lanes are arrays with a last axis of
8, seen through `lane_vector` (k, 8) and `lane_table` (i, k, 8), whose items are lanes.
"""

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import PrimitiveModel
from numba.core.imputils import lower_builtin, lower_cast
from numba.core.typeconv import Conversion
from numba.core.typing.templates import AbstractTemplate, ConcreteTemplate, infer_global, signature
from numba.extending import models, register_model

from uvms_dynamics.kernels.numba_internals.parts import intrinsic

LANES = 8
_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_INDEX = ir.IntType(64)
_ALIGNMENT = 8  # bytes; all that numpy promises of a row of numbers


class LanesType(types.Type):
    """Eight float64; a number where lanes are expected is broadcast to all eight."""

    def __init__(self) -> None:
        super().__init__("lanes")

    def can_convert_from(self, _context: Any, other: types.Type) -> Conversion | None:
        """Numbers become lanes."""
        return Conversion.promote if isinstance(other, types.Number) else None

    def unify(self, _context: Any, other: types.Type) -> types.Type | None:
        """A variable that is a number here and lanes there is lanes."""
        return self if isinstance(other, types.Number) else None


lanes = LanesType()


@register_model(LanesType)
class _LanesModel(PrimitiveModel):
    def __init__(self, manager: Any, kind: LanesType) -> None:
        super().__init__(manager, kind, _VECTOR)


@lower_cast(types.Number, lanes)
def _spread(context: Any, builder: Any, kind: types.Type, _lanes: LanesType, value: Any) -> Any:
    """The same number in all lanes."""
    number = context.cast(builder, value, kind, types.float64)
    first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), number, _INDEX(0))
    mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(first, ir.Constant(_VECTOR, ir.Undefined), mask)


def _define(plain: Callable, in_place: Callable, instruction: Callable) -> None:
    """An operator of two lanes, by one instruction."""
    for function in (plain, in_place):

        @infer_global(function)
        class _Typing(ConcreteTemplate):
            cases = (signature(lanes, lanes, lanes),)

        @lower_builtin(function, lanes, lanes)
        def _lowering(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
            return instruction(builder)(*args)


_define(operator.add, operator.iadd, lambda builder: builder.fadd)
_define(operator.sub, operator.isub, lambda builder: builder.fsub)
_define(operator.mul, operator.imul, lambda builder: builder.fmul)
_define(operator.truediv, operator.itruediv, lambda builder: builder.fdiv)


@infer_global(operator.neg)
class _NegativeTyping(ConcreteTemplate):
    cases = (signature(lanes, lanes),)


@lower_builtin(operator.neg, lanes)
def _negative(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
    return builder.fneg(args[0])


class LaneArrayType(types.Type):
    """A vector or a table of lanes."""

    def __init__(self, dimensions: int) -> None:
        self.dimensions = dimensions
        super().__init__(f"lane_array({dimensions})")


@register_model(LaneArrayType)
class _LaneArrayModel(models.StructModel):
    def __init__(self, manager: Any, kind: LaneArrayType) -> None:
        members = [("data", types.CPointer(types.float64)), ("columns", types.intp)]
        super().__init__(manager, kind, members)


def _view(dimensions: int) -> Callable:
    def typed(_context: Any, array: types.Type) -> Any:
        if not (
            isinstance(array, types.Array) and array.ndim == dimensions + 1 and array.is_c_contig
        ):
            return None

        def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            source = context.make_array(sig.args[0])(context, builder, args[0])
            view = cgutils.create_struct_proxy(sig.return_type)(context, builder)
            view.data = source.data
            view.columns = cgutils.unpack_tuple(builder, source.shape)[dimensions - 1]
            return view._getvalue()

        return LaneArrayType(dimensions)(array), generate

    return typed


@intrinsic
def lane_vector(context, array):
    """View of a contiguous array (k, 8) as k lanes; the array must outlive it."""
    return _view(1)(context, array)


@intrinsic
def lane_table(context, array):
    """View of a contiguous array (i, k, 8) as a table of lanes; the array must outlive it."""
    return _view(2)(context, array)


def _key_of(array: types.Type, index: types.Type) -> types.Type | None:
    """The index as int64, or a pair of them; None where it does not fit the array."""
    if not isinstance(array, LaneArrayType):
        return None
    if array.dimensions == 1:
        return types.intp if isinstance(index, types.Integer) else None
    fits = isinstance(index, types.BaseTuple) and len(index) == array.dimensions
    return types.UniTuple(types.intp, array.dimensions) if fits else None


@infer_global(operator.getitem)
class _GetItem(AbstractTemplate):
    def generic(self, args: Any, _keywords: Any) -> Any:
        key = _key_of(*args)
        return None if key is None else signature(lanes, args[0], key)


@infer_global(operator.setitem)
class _SetItem(AbstractTemplate):
    def generic(self, args: Any, _keywords: Any) -> Any:
        key = _key_of(*args[:2])
        return None if key is None else signature(types.void, args[0], key, lanes)


def _place(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """Pointer to the lanes at an index."""
    array = cgutils.create_struct_proxy(sig.args[0])(context, builder, value=args[0])
    if sig.args[0].dimensions == 1:
        item = args[1]
    else:
        row, column = cgutils.unpack_tuple(builder, args[1])
        item = builder.add(builder.mul(row, array.columns), column)
    place = builder.gep(array.data, [builder.mul(item, _INDEX(LANES))])
    return builder.bitcast(place, _VECTOR.as_pointer())


def _load(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.load(_place(context, builder, sig, args), align=_ALIGNMENT, typ=_VECTOR)


def _store(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    builder.store(args[2], _place(context, builder, sig, args), align=_ALIGNMENT)
    return context.get_dummy_value()


for _kind in (types.intp, types.BaseTuple):
    lower_builtin(operator.getitem, LaneArrayType, _kind)(_load)
    lower_builtin(operator.setitem, LaneArrayType, _kind, lanes)(_store)


@intrinsic
def lane_of(_context, value, lane):
    """One number of the eight; `lane` is 0..7."""

    def generate(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.extract_element(*args)

    return types.float64(value, types.intp), generate


@intrinsic
def with_lane(_context, value, lane, number):
    """The eight with one number changed."""

    def generate(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.insert_element(args[0], args[2], args[1])

    return value(value, types.intp, types.float64), generate


def is_table(kind: types.Type) -> bool:
    """Whether this is what the functions that count through rows can read: float64, contiguous."""
    return isinstance(kind, types.Array) and kind.is_c_contig and kind.dtype == types.float64


def _items(context: Any, builder: Any, kind: types.Type, table: Any, k: Any) -> Any:
    """Pointer to eight numbers of a contiguous table from number k on, counted through its rows."""
    array = context.make_array(kind)(context, builder, table)
    return builder.bitcast(builder.gep(array.data, [k]), _VECTOR.as_pointer())


@intrinsic
def lanes_at(_context, table, k):
    """Eight numbers of a contiguous table from number k on, counted through its rows."""
    if not is_table(table):
        return None

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        place = _items(context, builder, signature.args[0], *args)
        return builder.load(place, align=_ALIGNMENT, typ=_VECTOR)

    return lanes(table, types.intp), generate


@intrinsic
def put_lanes(_context, table, k, value):
    """Write eight numbers of a contiguous table from number k on, counted through its rows."""
    if not is_table(table):
        return None

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        place = _items(context, builder, signature.args[0], *args[:2])
        builder.store(args[2], place, align=_ALIGNMENT)
        return context.get_dummy_value()

    return types.void(table, types.intp, lanes), generate
