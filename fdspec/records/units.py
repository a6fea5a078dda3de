"""Units that record files are written in, in whatever spelling; which quantity each measures.

A spelling is read as a product of powers, so that CM/SEC**2, cm/sec/sec, m s^-2 and m/s² need no list.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.records import vocabulary
from fdspec.units import G

MAX_SPELLING: Final = 60

_LENGTHS: Final = {
    "m": Fraction(1), "meter": Fraction(1), "meters": Fraction(1), "metre": Fraction(1),
    "metres": Fraction(1),
    "metro": Fraction(1), "metros": Fraction(1), "м": Fraction(1), "mt": Fraction(1),
    "cm": Fraction(1, 100), "centimeter": Fraction(1, 100), "centimeters": Fraction(1, 100),
    "centimetre": Fraction(1, 100), "centimetres": Fraction(1, 100), "см": Fraction(1, 100),
    "cms": Fraction(1, 100),
    "mm": Fraction(1, 1000), "millimeter": Fraction(1, 1000), "millimeters": Fraction(1, 1000),
    "millimetre": Fraction(1, 1000), "millimetres": Fraction(1, 1000), "мм": Fraction(1, 1000),
    "km": Fraction(1000), "nm": Fraction(1, 10**9), "um": Fraction(1, 10**6), "μm": Fraction(1, 10**6),
    "in": Fraction(254, 10000), "inch": Fraction(254, 10000), "inches": Fraction(254, 10000),
    "ft": Fraction(3048, 10000), "foot": Fraction(3048, 10000), "feet": Fraction(3048, 10000),
}  # fmt: skip
_TIMES: Final = {
    **dict.fromkeys(
        ("s", "sec", "secs", "second", "seconds", "sek", "sekunde", "sekunden", "seg", "segs", "segundo",
        "segundos",
         "secondo", "secondi", "seconde", "secondes", "sn", "saniye", "с", "сек", "секунд", "秒", "초"),
        Fraction(1),
    ),
    **dict.fromkeys(
        ("ms", "msec", "msecs", "millisecond", "milliseconds", "millisec", "мс", "мсек", "毫秒", "ミリ秒"),
        Fraction(1, 1000),
    ),
    **dict.fromkeys(("us", "μs", "usec", "μsec", "microsecond", "microseconds", "мкс", "微秒"), Fraction(1,
    10**6)),
    **dict.fromkeys(("nsec", "nanosecond", "nanoseconds"), Fraction(1, 10**9)),
    **dict.fromkeys(
        ("min", "mins", "minute", "minutes", "minuten", "minuto", "minutos", "minuti", "dakika", "dk",
        "мин", "分", "分钟"),
        Fraction(60),
    ),
    **dict.fromkeys(("hr", "hrs", "hour", "hours", "stunden"), Fraction(3600)),
}  # fmt: skip
_FREQUENCIES: Final = {"hz": Fraction(1), "hertz": Fraction(1), "гц": Fraction(1), "khz": Fraction(1000)}
# Of a length, here s: gal and g are accelerations, which are written as length over time squared.
_GAL: Final = {"gal": Fraction(1, 100), "gals": Fraction(1, 100), "galileo": Fraction(1, 100),
               "mgal": Fraction(1, 10**5), "mgals": Fraction(1, 10**5), "milligal": Fraction(1, 10**5),
               "milligals": Fraction(1, 10**5), "гал": Fraction(1, 100), "ガル": Fraction(1, 100),
               "伽": Fraction(1, 100), "kine": Fraction(0)}  # fmt: skip
_STANDARD_GRAVITY: Final = Fraction("9.80665")
_G: Final = {
    **dict.fromkeys(("g", "gs", "gn", "g0", "grav", "gravity", "gravities", "gee", "gees", "重力加速度"),
    Fraction(1)),
    **dict.fromkeys(("mg", "mgs", "millig", "milligs"), Fraction(1, 1000)),
    **dict.fromkeys(("ug", "μg", "microg"), Fraction(1, 10**6)),
}  # fmt: skip

_NAMES: Final = {
    _STANDARD_GRAVITY: "g",
    Fraction(1): "m/s2",
    Fraction(1, 100): "cm/s2",
    Fraction(1, 1000): "mm/s2",
    Fraction(1, 10**5): "mgal",
    _STANDARD_GRAVITY / 1000: "mg",
    _STANDARD_GRAVITY / 100: "%g",
    _STANDARD_GRAVITY / 10: "g/10",
    Fraction(3048, 10000): "ft/s2",
    Fraction(254, 10000): "in/s2",
    Fraction(1, 10**6): "um/s2",
    Fraction(1, 10**9): "nm/s2",
}
KNOWN: Final = ("g", "m/s2", "cm/s2", "mm/s2", "gal", "mgal", "mg", "%g", "ft/s2", "in/s2")
"""What an error lists; every spelling of them is understood."""

_DIMENSIONS: Final = MappingProxyType(
    {
        (1, -2): vocabulary.ACCELERATION,
        (1, -1): vocabulary.VELOCITY,
        (1, 0): vocabulary.DISPLACEMENT,
        (0, 1): vocabulary.TIME,
        (0, -1): vocabulary.FREQUENCY,
    }
)
_WORD: Final = re.compile(r"\s*([^\W\d_]+0?|\^|\*|/|\(|\)|-?\d+|%|\.)")


@dataclass(frozen=True)
class Unit:
    """A unit that was understood: `name` is ours, `quantity` what it measures, `factor` its size in SI."""

    name: str
    quantity: str
    factor: Fraction


def unit_of(spelling: str) -> Unit | None:
    """Return the unit that a text spells, the whole of it and nothing else; None when it is no unit."""
    text = spelling.strip().strip("\"'`$[]<>").strip()
    if not text or len(text) > MAX_SPELLING or text.startswith(("/", "*", "^")):
        return None
    text = _simplified(text)
    return _percent(text) or _product(text)


def unit_named(spelling: str) -> str:
    """Return our name of a unit of acceleration, or say which are known."""
    name = acceleration_unit(spelling)
    if name is None:
        known = f"{', '.join(KNOWN[:-1])} or {KNOWN[-1]}"
        raise InvalidInput(f"units must be {known}, in any spelling, not {spelling!r}")
    return name


def acceleration_unit(spelling: str) -> str | None:
    """Return our name of the unit of acceleration that a text spells; None when it spells none."""
    unit = unit_of(spelling)
    return unit.name if unit is not None and unit.quantity == vocabulary.ACCELERATION else None


def to_si(values: NDArray[np.float64], unit: str) -> NDArray[np.float64]:
    """Return values given in `unit` (one of our names) in m/s2."""
    # Divided, not multiplied by 0.01: one rounding, of the number that the file shows.
    if unit == "g":
        return values * G
    divisors = {"m/s2": 1.0, "cm/s2": 100.0, "mm/s2": 1000.0, "mgal": 1e5, "um/s2": 1e6, "nm/s2": 1e9}
    if unit in divisors:
        return values / divisors[unit]
    if unit in {"ft/s2", "in/s2"}:
        return values * {"ft/s2": 0.3048, "in/s2": 0.0254}[unit]
    return values / {"mg": 1000.0, "%g": 100.0, "g/10": 10.0}[unit] * G


def _simplified(text: str) -> str:
    text = unicodedata.normalize("NFKC", text).casefold().translate({0x2212: "-", 0x2013: "-", 0x2032: "'"})
    text = re.sub(r"[{}\\]|'s$|’s$", "", text)
    text = re.sub(r"\*\*", "^", text)
    text = re.sub(r"[·∙⋅×]", "*", text)
    text = re.sub(r"\b(?:per|par|pro|por|bolu)\b|÷", "/", text)
    text = re.sub(r"\bsquared?\s+(s\w*)", r"\1^2", text)
    text = re.sub(r"\b(?:square[ds]?|al cuadrado|au carre|hoch 2|zum quadrat)\b|\bsq\b\.?", "^2", text)
    text = re.sub(r"\^2\s*(s\w*)$", r"\1^2", text)  # cm/sq.sec
    text = re.sub(r"^(m|cm|mm|ft|in)s\s*\^?\s*\(?(-[12])\)?$", r"\1 s^\2", text)  # ms-2 is no millisecond
    return text.strip(" .:")


def _percent(text: str) -> Unit | None:
    rest = re.sub(r"^(?:%|percent|pct|per cent)\s*(?:of\s+)?", "", text)
    if rest != text and rest in _G and _G[rest] == 1:
        return _named(_STANDARD_GRAVITY / 100, (1, -2))
    return None


def _product(text: str) -> Unit | None:
    """Read a product of powers; what follows the first slash is below it, as people write cm/s*s."""
    words: list[str] = []
    at = 0
    while at < len(text):
        match = _WORD.match(text, at)
        if match is None:
            return None
        words.append(match[1])
        at = match.end()
    factor, length, time = Fraction(1), 0, 0
    below = False
    k = 0
    bases = 0
    while k < len(words):
        word = words[k]
        k += 1
        if word == "/":
            below = True
            if words[k:] == ["10"] and words[0] == "g" and bases == 1:  # as CDMG and BHRC write
                return _named(_STANDARD_GRAVITY / 10, (1, -2))
            continue
        if word in {"*", ".", "(", ")"}:
            continue
        base = _base(word)
        power = 1
        if k < len(words) and words[k] == "^":
            k += 1
            if k < len(words) and words[k] == "(":
                k += 1
            if k >= len(words) or not re.fullmatch(r"-?\d", words[k]):
                return None
            power = int(words[k])
            k += 1
        elif k < len(words) and re.fullmatch(r"-?\d", words[k]):
            power = int(words[k])
            k += 1
        if base is None or power == 0 or (below and power < 0):
            return None
        bases += 1
        size, of_length, of_time = base
        sign = -1 if below else 1
        factor *= size ** (sign * power)
        length += sign * power * of_length
        time += sign * power * of_time
    return _named(factor, (length, time)) if bases else None


def _base(word: str) -> tuple[Fraction, int, int] | None:
    """Return size, power of length and power of time of one word."""
    if word in _TIMES:
        return _TIMES[word], 0, 1
    if word in _LENGTHS:
        return _LENGTHS[word], 1, 0
    if word in _FREQUENCIES:
        return _FREQUENCIES[word], 0, -1
    if word == "kine":
        return Fraction(1, 100), 1, -1
    if word in _GAL:
        return _GAL[word], 1, -2
    if word in _G:
        return _G[word] * _STANDARD_GRAVITY, 1, -2
    return None


def _named(factor: Fraction, dimensions: tuple[int, int]) -> Unit | None:
    quantity = _DIMENSIONS.get(dimensions)
    if quantity is None:
        return None
    if quantity == vocabulary.ACCELERATION:
        return Unit(_NAMES[factor], quantity, factor) if factor in _NAMES else None
    symbols = {(1, -1): "m/s", (1, 0): "m", (0, 1): "s", (0, -1): "Hz"}
    symbol = symbols[dimensions]
    return Unit(symbol if factor == 1 else f"{float(factor):g} {symbol}", quantity, factor)
