"""Four storeys at a time: tuples of four numbers, kept in registers.

A loop over a handful of storeys spends most of its time on being a loop; four of them written out
side by side hide each other's latency.  Series are stored storey by storey, so that each is a
polynomial in one piece; `load` and `store` go across four of them.  No views of arrays: each costs two
atomic counts of references, which is much in a loop of a microsecond.
"""

from __future__ import annotations

from fdspec.compiler.options import inlined

LANES = 4


@inlined
def load(a, q, i, k):
    """Entries k of rows i to i + 3 of quantity q."""
    return a[q, i, k], a[q, i + 1, k], a[q, i + 2, k], a[q, i + 3, k]


@inlined
def row(a, k, i):
    """Entries i to i + 3 of row k."""
    return a[k, i], a[k, i + 1], a[k, i + 2], a[k, i + 3]


@inlined
def store(a, q, i, k, x):
    """Set entries k of rows i to i + 3 of quantity q."""
    a[q, i, k] = x[0]
    a[q, i + 1, k] = x[1]
    a[q, i + 2, k] = x[2]
    a[q, i + 3, k] = x[3]


@inlined
def store_row(a, k, i, x):
    """Set entries i to i + 3 of row k."""
    a[k, i] = x[0]
    a[k, i + 1] = x[1]
    a[k, i + 2] = x[2]
    a[k, i + 3] = x[3]


@inlined
def plus(x, y):
    """Sum."""
    return x[0] + y[0], x[1] + y[1], x[2] + y[2], x[3] + y[3]


@inlined
def minus(x, y):
    """Difference."""
    return x[0] - y[0], x[1] - y[1], x[2] - y[2], x[3] - y[3]


@inlined
def times(x, y):
    """Product."""
    return x[0] * y[0], x[1] * y[1], x[2] * y[2], x[3] * y[3]


@inlined
def scaled(x, factor):
    """Product with one number."""
    return x[0] * factor, x[1] * factor, x[2] * factor, x[3] * factor


@inlined
def less(x, number):
    """Each less one number."""
    return x[0] - number, x[1] - number, x[2] - number, x[3] - number


@inlined
def rise_from(x, below):
    """Each less the one before it, the first less ``below``."""
    return x[0] - below, x[1] - x[0], x[2] - x[1], x[3] - x[2]


@inlined
def shifted(x, above):
    """Each replaced by the one after it, the last by ``above``."""
    return x[1], x[2], x[3], above


@inlined
def magnitude(x):
    """Absolute values."""
    return abs(x[0]), abs(x[1]), abs(x[2]), abs(x[3])


@inlined
def total_of(x):
    """Sum of all four."""
    return (x[0] + x[1]) + (x[2] + x[3])
