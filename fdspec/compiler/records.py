"""Records in rows of arrays: a NamedTuple of floats, or of such NamedTuples, read from a row and written.

Numbers stand in the order of the fields, those of a nested record in its field's place.  Compiled, a read is
a load for each number that is used.  Indices are not checked: a row must be long enough, see `size_of`.
"""

from __future__ import annotations

from typing import Any, get_type_hints

from numba import config, types
from numba.core import cgutils
from numba.extending import intrinsic


def size_of(cls: Any) -> int:
    """Return how many numbers a record has."""
    hints = get_type_hints(cls)
    return sum(1 if hints[name] is float else size_of(hints[name]) for name in cls._fields)


def _type_of(cls: Any) -> types.Type:
    """Return what numba takes a record for: a uniform tuple where all fields are of one type."""
    hints = get_type_hints(cls)
    fields = [types.float64 if hints[name] is float else _type_of(hints[name]) for name in cls._fields]
    if len(set(fields)) == 1:
        return types.NamedUniTuple(fields[0], len(fields), cls)
    return types.NamedTuple(fields, cls)


if config.DISABLE_JIT:

    def read(cls: Any, rows: Any, i: int) -> Any:
        """Return the record in row i."""
        hints, at, values = get_type_hints(cls), 0, []
        for name in cls._fields:
            size = 1 if hints[name] is float else size_of(hints[name])
            part = rows[i, at : at + size]
            values.append(part[0] if hints[name] is float else read(hints[name], part[None], 0))
            at += size
        return cls(*values)

    def write(rows: Any, i: int, record: Any) -> None:
        """Write the record to row i."""
        at = 0
        for value in record:
            size = size_of(type(value)) if isinstance(value, tuple) else 1
            if isinstance(value, tuple):
                write(rows[i : i + 1, at : at + size], 0, value)
            else:
                rows[i, at] = value
            at += size

else:

    def _first(context: Any, builder: Any, kind: Any, rows: Any, i: Any) -> Any:
        """Give the address of the first number of a row of a contiguous array (m, n)."""
        array = context.make_array(kind)(context, builder, rows)
        columns = cgutils.unpack_tuple(builder, array.shape, 2)[1]
        return builder.gep(array.data, [builder.mul(i, columns)])

    def _load(context: Any, builder: Any, kind: Any, first: Any, at: int) -> tuple[Any, int]:
        """Load a record, or a number, from place ``at`` on; give it with the place behind it."""
        if kind is types.float64:
            return builder.load(builder.gep(first, [context.get_constant(types.intp, at)])), at + 1
        values = []
        for part in kind.types:
            value, at = _load(context, builder, part, first, at)
            values.append(value)
        return context.make_tuple(builder, kind, values), at

    def _store(context: Any, builder: Any, kind: Any, value: Any, first: Any, at: int) -> int:
        """Store a record, or a number, from place ``at`` on; give the place behind it."""
        if kind is types.float64:
            builder.store(value, builder.gep(first, [context.get_constant(types.intp, at)]))
            return at + 1
        for k, part in enumerate(kind.types):
            at = _store(context, builder, part, builder.extract_value(value, k), first, at)
        return at

    @intrinsic  # type: ignore[untyped-decorator]
    def read(typing_context: Any, cls: Any, rows: Any, i: Any) -> Any:  # noqa: ARG001
        """Return the record in row i."""
        kind = _type_of(cls.instance_class)

        def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            first = _first(context, builder, signature.args[1], arguments[1], arguments[2])
            return _load(context, builder, kind, first, 0)[0]

        return kind(cls, rows, types.intp), code

    @intrinsic  # type: ignore[untyped-decorator]
    def write(typing_context: Any, rows: Any, i: Any, record: Any) -> Any:  # noqa: ARG001
        """Write the record to row i."""

        def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            first = _first(context, builder, signature.args[0], arguments[0], arguments[1])
            _store(context, builder, signature.args[2], arguments[2], first, 0)
            return context.get_dummy_value()

        return types.void(rows, types.intp, record), code
