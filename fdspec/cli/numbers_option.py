"""Options that hold several numbers: a list, or a range with a count."""

from __future__ import annotations

from typing import Any

import click


class Numbers(click.ParamType[list[float]]):
    """`0.1,0.5,1`, or `0.05:5:100` for a hundred numbers evenly spaced on a logarithmic scale, or both in
    one."""

    name = "numbers"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> list[float]:
        """Return the numbers, rising, each once."""
        import numpy as np

        if isinstance(value, list):
            return value
        found: list[float] = []
        for piece in str(value).split(","):
            parts = piece.split(":")
            try:
                numbers = [float(part) for part in parts]
                count = int(parts[2]) if len(parts) == 3 else 0
            except ValueError:
                self.fail(f"{piece!r} is no number and no LOW:HIGH:COUNT", param, ctx)
            if len(parts) == 1:
                found += numbers
            elif len(parts) == 3 and 0.0 < numbers[0] < numbers[1] and 2 <= count <= 100_000:
                found += np.geomspace(numbers[0], numbers[1], count).tolist()
            else:
                self.fail(
                    f"{piece!r} is no range LOW:HIGH:COUNT with 0 < LOW < HIGH and COUNT from 2", param, ctx
                )
        return sorted(set(found))
