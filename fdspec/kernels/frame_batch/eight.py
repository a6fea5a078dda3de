"""Eight numbers at once: a vector of doubles as a type of its own, one lane a history.

Loops over lanes that the compiler turns into vectors keep every intermediate result in memory; a value
of this type stays in a register.  Without the JIT it is an array of eight.
"""

from __future__ import annotations

import operator
from typing import Any, Final

import numpy as np
from numba import config, types

WIDTH: Final = 8
"""Lanes: a register of AVX-512, two of AVX2, four of SSE2; the same bits in each."""

ALL: Final = (1 << WIDTH) - 1
"""The set of all lanes, a bit for each."""

if config.DISABLE_JIT:

    def load(a: Any, at: int) -> Any:
        """Give the eight numbers of a flat array from this place on."""
        return a[at : at + WIDTH].copy()

    def store(a: Any, at: int, x: Any) -> None:
        """Put eight numbers into a flat array from this place on."""
        a[at : at + WIDTH] = x

    def splat(x: float) -> Any:
        """Give one number eight times."""
        return np.full(WIDTH, x)

    def fma8(a: Any, b: Any, c: Any) -> Any:
        """Give a b + c, here rounded twice."""
        return a * b + c

    def less8(c: Any, a: Any, b: Any) -> Any:
        """Give c - a b, here rounded twice."""
        return c - a * b

    def abs8(a: Any) -> Any:
        """Give magnitudes."""
        return np.abs(a)

    def max8(a: Any, b: Any) -> Any:
        """Give the greater of each two, or b where either is no number."""
        return np.where(a > b, a, b)

    def min8(a: Any, b: Any) -> Any:
        """Give the lesser of each two, or b where either is no number."""
        return np.where(a < b, a, b)

    def sqrt8(a: Any) -> Any:
        """Give square roots."""
        return np.sqrt(a)

    def where_above(a: Any, b: Any, x: Any, y: Any) -> Any:
        """Give x where a > b, else y."""
        return np.where(a > b, x, y)

    def where_in(lanes: int, x: Any, y: Any) -> Any:
        """Give x in the lanes of a set, else y."""
        return np.where([lanes >> lane & 1 for lane in range(WIDTH)], x, y)

    def above(a: Any, b: Any) -> int:
        """Give the set of lanes in which a > b; where either is no number it is not."""
        return int(np.packbits(a > b, bitorder="little")[0])

else:
    from llvmlite import ir
    from numba.core import cgutils
    from numba.core.typing.templates import AbstractTemplate, infer_global, signature
    from numba.extending import intrinsic, lower_builtin, models, register_model

    VECTOR = ir.VectorType(ir.DoubleType(), WIDTH)

    class Eight(types.Type):  # type: ignore[misc]
        """The numba type of eight doubles in a register."""

        def __init__(self) -> None:
            super().__init__(name="Eight")

    eight = Eight()

    @register_model(Eight)
    class _EightModel(models.PrimitiveModel):  # type: ignore[misc]
        def __init__(self, manager: Any, fe_type: Any) -> None:
            super().__init__(manager, fe_type, VECTOR)

    def _binary(operation: Any, emit: str) -> None:
        @infer_global(operation)
        class _Typing(AbstractTemplate):  # type: ignore[misc]
            def generic(self, args: Any, kws: Any) -> Any:  # noqa: ARG002
                return signature(eight, eight, eight) if args == (eight, eight) else None

        @lower_builtin(operation, Eight, Eight)
        def _code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            return getattr(builder, emit)(*args)

    _binary(operator.add, "fadd")
    _binary(operator.sub, "fsub")
    _binary(operator.mul, "fmul")
    _binary(operator.truediv, "fdiv")

    def _called(builder: Any, name: str, *args: Any) -> Any:
        """Call an operation of LLVM on vectors."""
        of = ir.FunctionType(VECTOR, [VECTOR] * len(args))
        function = cgutils.get_or_insert_function(builder.module, of, f"llvm.{name}.v{WIDTH}f64")
        return builder.call(function, args)

    def _place(context: Any, builder: Any, array_type: Any, array: Any, at: Any) -> Any:
        data = context.make_array(array_type)(context, builder, array).data
        return builder.bitcast(builder.gep(data, [at]), VECTOR.as_pointer())

    @intrinsic
    def load(typing_context: Any, a: Any, at: Any) -> Any:  # noqa: ARG001
        """Give the eight numbers of a flat array from this place on."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            found = builder.load(_place(context, builder, sig.args[0], *args))
            found.align = 8
            return found

        return eight(a, types.intp), code

    @intrinsic
    def store(typing_context: Any, a: Any, at: Any, x: Any) -> Any:  # noqa: ARG001
        """Put eight numbers into a flat array from this place on."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            builder.store(args[2], _place(context, builder, sig.args[0], *args[:2]), align=8)
            return context.get_dummy_value()

        return types.void(a, types.intp, eight), code

    @intrinsic
    def splat(typing_context: Any, x: Any) -> Any:  # noqa: ARG001
        """Give one number eight times."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            one = ir.Constant(ir.IntType(32), 0)
            empty = ir.Constant(VECTOR, ir.Undefined)
            first = builder.insert_element(empty, args[0], one)
            return builder.shuffle_vector(
                first, empty, ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), None)
            )

        return eight(types.float64), code

    @intrinsic
    def fma8(typing_context: Any, a: Any, b: Any, c: Any) -> Any:  # noqa: ARG001
        """Give a b + c, rounded once."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            return _called(builder, "fma", *args)

        return eight(eight, eight, eight), code

    @intrinsic
    def less8(typing_context: Any, c: Any, a: Any, b: Any) -> Any:  # noqa: ARG001
        """Give c - a b, rounded once."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            return _called(builder, "fma", builder.fneg(args[1]), args[2], args[0])

        return eight(eight, eight, eight), code

    @intrinsic
    def abs8(typing_context: Any, a: Any) -> Any:  # noqa: ARG001
        """Give magnitudes."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            return _called(builder, "fabs", *args)

        return eight(eight), code

    @intrinsic
    def sqrt8(typing_context: Any, a: Any) -> Any:  # noqa: ARG001
        """Give square roots."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            return _called(builder, "sqrt", *args)

        return eight(eight), code

    @intrinsic
    def max8(typing_context: Any, a: Any, b: Any) -> Any:  # noqa: ARG001
        """Give the greater of each two, or b where either is no number."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            return builder.select(builder.fcmp_ordered(">", *args), *args)

        return eight(eight, eight), code

    @intrinsic
    def min8(typing_context: Any, a: Any, b: Any) -> Any:  # noqa: ARG001
        """Give the lesser of each two, or b where either is no number."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            return builder.select(builder.fcmp_ordered("<", *args), *args)

        return eight(eight, eight), code

    @intrinsic
    def where_above(typing_context: Any, a: Any, b: Any, x: Any, y: Any) -> Any:  # noqa: ARG001
        """Give x where a > b, else y."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            return builder.select(builder.fcmp_ordered(">", *args[:2]), *args[2:])

        return eight(eight, eight, eight, eight), code

    @intrinsic
    def where_in(typing_context: Any, lanes: Any, x: Any, y: Any) -> Any:  # noqa: ARG001
        """Give x in the lanes of a set, else y."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            bits = builder.trunc(args[0], ir.IntType(WIDTH))
            mask = builder.bitcast(bits, ir.VectorType(ir.IntType(1), WIDTH))
            return builder.select(mask, *args[1:])

        return eight(types.int64, eight, eight), code

    @intrinsic
    def above(typing_context: Any, a: Any, b: Any) -> Any:  # noqa: ARG001
        """Give the set of lanes in which a > b; where either is no number it is not."""

        def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ARG001
            bits = builder.bitcast(builder.fcmp_ordered(">", *args), ir.IntType(WIDTH))
            return builder.zext(bits, ir.IntType(64))

        return types.int64(eight, eight), code
