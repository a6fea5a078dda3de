"""Plain tables: columns of text that line up, on a terminal and in a pipe alike."""

from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[str]], *, left: Sequence[str] = ()) -> str:
    """Return lines with a head; columns named in `left` are aligned to the left, others to the right."""
    lines = [list(head), *(list(row) for row in rows)]
    widths = [max(len(line[column]) for line in lines) for column in range(len(head))]
    aligned = [
        "  ".join(
            cell.ljust(width) if name in left else cell.rjust(width)
            for name, cell, width in zip(head, line, widths, strict=True)
        ).rstrip()
        for line in lines
    ]
    return "\n".join(aligned)


def grouped(number: float) -> str:
    """Write a whole number with its thousands apart, as 41 580."""
    return f"{number:,.0f}".replace(",", " ")


def counted(number: int, one: str, many: str = "") -> str:
    """Write a number of things: 1 record, 9 records."""
    return f"{grouped(number)} {one if number == 1 else many or one + 's'}"


def seconds(time: float) -> str:
    """Write a time for a person."""
    if time < 9.95:
        return f"{time:.1f} s"
    if time < 120:
        return f"{time:.0f} s"
    if time < 7200:
        return f"{time / 60:.0f} min"
    return f"{time / 3600:.1f} h"


def size(n_bytes: float) -> str:
    """Write a size for a person, in decimal units."""
    for unit in ("bytes", "kB", "MB"):
        if n_bytes < 1000:
            return f"{n_bytes:.3g} {unit}"
        n_bytes /= 1000
    return f"{n_bytes:.3g} GB"
