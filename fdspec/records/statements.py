"""What the lines above the values say in words: how many values, at which step, in which unit, of what.

The order of the words and their spelling vary from hand to hand; each statement is found by itself. Notes
about peaks, ranges and filters are no statements about the values. Every pattern works on the first 400
characters of a line and has bounded repetitions only.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Final

from fdspec.records import vocabulary
from fdspec.records.numbers import parse_number
from fdspec.records.units import Unit, unit_of
from fdspec.records.vocabulary import plain

MAX_STATEMENT: Final = 400

_NUMBER: Final = r"[+-]?(?:\d{1,12}\.?\d{0,18}|\.\d{1,18})(?:[ed][+-]?\d{1,3})?(?![\w.])"
_OPTIONAL_UNIT: Final = r"(?:\s{0,3}[(\[]\s{0,3}(?P<key_unit>[^()\[\]]{1,20})[)\]])?"
_IS: Final = r"(?:\s{0,8}(?:[:=]|is\b|are\b|of\b|at\b)){0,2}\s{0,12}"
_NOUN: Final = (
    r"(?:data\s?points?|points?|pts|samples?|values?|data|readings|ordinates|steps|lines of data|"
    r"muestras|datos|puntos|valores|punti|dati|campioni|valori|werten?|punkten?|datenpunkten?|stutzstellen|abtastwerten?|"
    r"echantillons|valeurs|donnees|veri|ornek|nokta|amostras|pontos|dados|точек|отсчетов|отсчетов|значении)"
)
_OF: Final = r"(?:\s{0,3}(?:of|de|di|der|des|d'|von|total|the|all|datos|acceleration|accel|acc|time|data))"
_COUNT_KEY: Final = (
    rf"(?:npts?|npoints|npt|ndata|ndat|nsamples?|nsamp|nstep|nsteps|n_points|n_samples|"
    rf"(?:number|numbers|no\.?|num\.?|nb\.?|nr\.?|numero|nombre|anzahl|count|total)(?:{_OF}){{0,3}}\s{{0,3}}{_NOUN}|"
    rf"{_NOUN}\s(?:sayisi|count|number|anzahl)|число\s(?:точек|отсчетов|отсчетов)|"
    rf"(?:数据)?点数|(?:データ|サンプル)(?:数|点数)|采样点数)"
)
_BARE_COUNT_KEY: Final = rf"(?:{_NOUN}|n)"
_STEP_KEY: Final = (
    r"(?:dt|delta[ _]?t|δt|dtime|(?:time|sampling|sample|data|digiti[sz]ing)[ _-]?(?:step|increment|"
    r"interval|spacing|delta|period)s?"
    r"(?: s| sec)?|time between samples|"
    r"(?:equally|evenly|uniformly)[ -]?spaced(?:\s(?:intervals?|points|at))?|"
    r"equal(?:ly)?[ -]?(?:spacing|intervals?|(?:time )?steps?)|"
    r"zeitschritt(?:weite)?|abtastintervall|zeitinkrement|zeitintervall|pas(?: de temps|"
    r" d'echantillonnage)?|paso(?: de tiempo)?|"
    r"intervalo(?: de (?:muestreo|tiempo|amostragem))?|incremento(?: de tiempo| temporale)?|"
    r"passo(?: temporale| di campionamento| de tempo)?|intervallo(?: di campionamento| di tempo)?|"
    r"zaman (?:adimi|araligi)|ornekleme araligi|шаг(?: дискретизации| по времени)?|"
    r"采样间隔|时间间隔|时间步长|采样周期|サンプリング間隔|時間間隔|時間刻み)"
)
_RATE_KEY: Final = (
    r"(?:sampl(?:e|ing)[ _-]?(?:rate|freq(?:uency)?|frequenz)(?: hz)?|data[ _-]rate|samprate|"
    r"(?:sps|fs|samples?\s?(?:/|per)\s?(?:s|sec|second))(?=\s{0,9}[:=])|"
    r"abtast(?:rate|frequenz)|frequence d'echantillonnage|"
    r"(?:frecuencia|velocidad|vel\.|tasa) de muestreo|frequenza di campionamento|taxa de amostragem|"
    r"ornekleme (?:frekansi|hizi|orani)|частота дискретизации|采样(?:频)?率|采样频率|"
    r"サンプリング(?:周波数|レート)|標本化周波数)"
)
_NOT_A_COUNT: Final = re.compile(
    r"(?:skipped|missing|lost|bad|dropped|clipped|spurious|interpolated|leading|trailing|first|last|pre-?event|"
    r"padded|each|every|db|period|frequency)\s{0,3}$"
)
_KEY_COUNT: Final = re.compile(
    rf"(?<![\w]){_COUNT_KEY}{_OPTIONAL_UNIT}{_IS}(?P<n>\d{{1,12}})(?!\d|[\w.,]\d|[a-z])"
)
_BARE_COUNT: Final = re.compile(
    rf"(?<![\w]){_BARE_COUNT_KEY}\s{{0,3}}[:=]\s{{0,12}}(?P<n>\d{{1,12}})(?!\.\d|\w)"
)
_COUNT_WITHOUT_NUMBER: Final = re.compile(rf"(?<![\w]){_COUNT_KEY}\s{{0,3}}[:=]\s{{0,12}}(?:,|;|[a-z]|$)")
_COUNT_NOUN: Final = re.compile(
    r"(?<![\w.^+-])(?P<n>\d{1,12})\s{1,3}(?:(?:data|accelerogram|acceleration|accel|acc|record|time|discrete|digiti[sz]ed|"
    rf"equally[ -]spaced|uncorrected|corrected)\s){{0,2}}{_NOUN}\b"
    r"(?!\s{0,2}(?:/|per\b|a\b|across|in each|each|in a\b|on each|pro\b|par\b|por\b|wide|to the))"
)
_KEY_STEP: Final = re.compile(
    rf"(?<![\w]){_STEP_KEY}{_OPTIONAL_UNIT}{_IS}(?P<n>{_NUMBER})\s{{0,3}}(?P<unit>[^\W\d]{{1,12}})?"
)
_KEY_RATE: Final = re.compile(
    rf"(?<![\w]){_RATE_KEY}{_OPTIONAL_UNIT}{_IS}(?P<n>{_NUMBER.replace('(?![' + chr(92) + 'w.])', '')})"
    r"\s{0,3}(?P<unit>hz|khz|sps|samples?/s(?:ec)?|1/s)?"
)
_RATE_NOUN: Final = re.compile(
    rf"(?<![\w.^+-])(?P<n>{_NUMBER})\s{{0,3}}(?:(?:samples?|points?|pts|values?|data)\s{{0,2}}(?:/|per|a)\s{{0,2}}"
    r"(?:s|sec|second)\b|sps\b)(?!\s{0,3}[:=])"
)
_NUMBERS_THEN_KEYS: Final = re.compile(
    rf"\s{{0,40}}(?P<first>{_NUMBER})[\s,]{{1,40}}(?P<second>{_NUMBER})[\s,]{{1,40}}"
    r"(?P<keys>npts?\s{0,9},?\s{0,9}dt|dt\s{0,9},?\s{0,9}npts?)\b"
)
_UNIT_WORD: Final = re.compile(
    r"\b(?:units?|einheit(?:en)?|unidad(?:es)?|unita|unites?|birimi?|единиц[аы]|unidade)\b|单位|單位|単位"
)
_UNIT_FILLER: Final = re.compile(
    r"(?:\s|:|=|\(|\[|\bof\b|\bis\b|\bare\b|\bin\b(?=\s)|\bde\b|\bdi\b|\bfor\b|\bthe\b|\bdata\b|\bdatos\b|\blos\b|\bla\b|\bdei\b|"
    r"\bdati\b|\buncor\b|\bcorr?\b|\bground\b|\bmotion\b|\bvalues?\b|\baccel\w*|\bacc\b|\baceler\w*|"
    r"\bbeschl\w*|\bsec and\b){0,8}"
)
_ACCELERATION: Final = re.compile(
    r"\b(?:acc?ell?\w{0,14}|acc|acceler\w*|aceler\w*|beschleunigung\w*|ivme\w*|ускорени\w*)\b|加速度"
)
_BEFORE_UNIT: Final = re.compile(r"\bin\b\s{0,3}(?:units?\sof\s)?|[(\[]|,\s|:\s|=\s|\ben\b\s|/\s|\bdans\b\s")
_A_NOTE: Final = re.compile(
    r"\b(?:pga|pgv|pgd|pk|peak\w*|max\w*|min|minimum|range|full.?scale|fullscale|scale\w*|factor|sensitiv\w*|trigger\w*|"
    r"threshold|rms|resolution|limit\w*|noise|gain|escala|esc|sensib\w*|umbral|massim\w*|picco|spitze\w*|maks\w*|"
    r"en buyuk|arias|target|duration)\b|最大|峰值|ピーク"
)
_BLANKS: Final = re.compile(r"\s{3,}")
_BRACKETED: Final = re.compile(r"[\[(]\s{0,3}([^()\[\]]{1,20})[\])]")
_INSTRUMENT: Final = re.compile(
    r"(?:accelero|acelero)(?:met|graph|graf)\w*|accelerometr\w*|velocimet\w*|速度計|加速度計"
)
_OF_PEAKS: Final = re.compile(
    r"\b(?:pga|pgv|pgd|peaks?|range|full.?scale|fullscale|sensitiv\w*|trigger\w*|threshold|resolution|limits?|noise|"
    r"gain|factor|arias|vs30)\b"
)
_OF_FILTERS: Final = re.compile(
    r"\b(?:filter|cut-?off|cut|corner|poles?|order|nyquist|pass|bandpass|magnitude)\b"
)
_CLAUSE: Final = re.compile(r"[;,]\s|\s{3,}")
_COMPONENTS: Final = re.compile(
    r"\b(?:components?|channels?|directions?|orientation|komponenten?|richtungen?|componentes?|canales|composantes?|"
    r"componenti|canali|bilesenler)\b\s{0,3}[:=]\s{0,3}(?P<names>[^:=]{1,120})$"
)


@dataclass
class Statements:
    """What was stated, each with its line (counted from 1) and the words that say it.

    `bracketed` are units of acceleration that stand in brackets, and nothing says of what.
    """

    counts: list[tuple[int, int, str]] = field(default_factory=list)
    steps: list[tuple[int, float | None, str]] = field(default_factory=list)
    units: list[tuple[int, Unit, str]] = field(default_factory=list)
    bracketed: list[tuple[int, Unit, str]] = field(default_factory=list)
    components: list[tuple[int, list[str]]] = field(default_factory=list)
    mentioned: dict[str, set[int]] = field(default_factory=dict)


def statements(lines: Iterable[tuple[int, str]], *, decimal_comma: bool = False) -> Statements:
    """Return what numbered lines state."""
    found = Statements()
    for number, line in lines:
        _read_line(found, number, _prepared(line, decimal_comma))
        if match := _COMPONENTS.search(line[:MAX_STATEMENT].casefold()):
            names = line[:MAX_STATEMENT][match.start("names") :].replace(",", " ").replace("/", " ").split()
            found.components.append((number, names))
    return found


def is_note(line: str) -> bool:
    """Say whether a line is about a peak, a range or a filter, or says that something has a value."""
    text = plain(line[:MAX_STATEMENT])
    return (
        _OF_PEAKS.search(text) is not None
        or _OF_FILTERS.search(text) is not None
        or re.search(r"\bunits? (?:of|are|is)\b", text) is not None
    )


def _prepared(line: str, decimal_comma: bool) -> str:
    text = (
        plain(_BLANKS.sub("   ", line[: 4 * MAX_STATEMENT])[:MAX_STATEMENT])
        .replace("_", " ")
        .replace("**", "^")
    )
    text = text.replace("\u2206", "δ")
    if decimal_comma:
        text = re.sub(r"(?<=\d),(?=\d)", ".", text)
    return text


def _read_line(found: Statements, number: int, text: str) -> None:
    if not any(char.isalpha() for char in text):
        return
    _read_counts(found, number, text)
    _read_steps(found, number, text)
    start = 0
    pieces = []
    for mark in _CLAUSE.finditer(text):
        pieces.append((start, mark.start()))
        start = mark.end()
    pieces.append((start, len(text)))
    for first, last in pieces:
        _read_unit(found, number, text[first:last], text[first:])
    if not _A_NOTE.search(text) and "initial" not in text and "vs30" not in text:
        for quantity in (
            vocabulary.ACCELERATION, vocabulary.VELOCITY, vocabulary.DISPLACEMENT, vocabulary.SPECTRAL,
        ):  # fmt: skip
            if vocabulary.mentions(_INSTRUMENT.sub(" ", text), quantity):
                found.mentioned.setdefault(quantity, set()).add(number)


def _read_counts(found: Statements, number: int, text: str) -> None:
    if both := _NUMBERS_THEN_KEYS.match(text):
        count, step = both["first"], both["second"]
        if both["keys"].startswith("dt"):
            count, step = step, count
        if count.isdigit():
            found.counts.append((number, int(count), both[0].strip()))
            found.steps.append((number, _positive(step), both[0].strip()))
        return
    found.counts += [(number, 0, match[0].strip()) for match in _COUNT_WITHOUT_NUMBER.finditer(text)]
    taken: list[tuple[int, int]] = []
    for pattern in (_KEY_COUNT, _COUNT_NOUN, _BARE_COUNT):
        for match in pattern.finditer(text):
            if _NOT_A_COUNT.search(text[: match.start()]) or any(a <= match.start("n") < b for a, b in taken):
                continue
            if pattern is _BARE_COUNT and match[0].startswith("n") and match[0][1:2].isalpha():
                continue
            taken.append(match.span())
            found.counts.append((number, int(match["n"]), match[0].strip()))


def _read_steps(found: Statements, number: int, text: str) -> None:
    if _NUMBERS_THEN_KEYS.match(text):
        return
    for match in _KEY_STEP.finditer(text):
        value = _positive(match["n"])
        unit = unit_of(match["key_unit"] or "") or unit_of(match["unit"] or "")
        if unit is None and re.search(
            r"[ _]s(?:ec)?$", match[0][: match.start("n") - match.start()].rstrip(" :=")
        ):
            unit = unit_of("s")
        if unit is not None and unit.quantity == vocabulary.FREQUENCY:
            continue
        if value is not None and unit is not None and unit.quantity == vocabulary.TIME:
            value = float(Fraction(repr(value)) * unit.factor)
        elif value is not None and value >= 1.0:
            value = None  # seconds, milliseconds? an accelerogram has no steps of a second
        found.steps.append((number, value, match[0].strip()))
    for pattern in (_KEY_RATE, _RATE_NOUN):
        for match in pattern.finditer(text):
            rate = _positive(match["n"])
            if rate is None:
                continue
            kilo = pattern is _KEY_RATE and "khz" in ((match["unit"] or ""), (match["key_unit"] or ""))
            step = 1.0 / (rate * (1000.0 if kilo else 1.0))
            if (number, step) not in [(line, other) for line, other, _ in found.steps]:
                found.steps.append((number, step, match[0].strip()))


def _positive(word: str) -> float | None:
    value = parse_number(word)
    return value if value is not None and value > 0.0 else None


def _read_unit(found: Statements, number: int, clause: str, rest: str) -> None:
    """Find a unit behind the word unit, or behind acceleration and in, a bracket or a comma."""
    if _A_NOTE.search(clause):
        return
    if word := _UNIT_WORD.search(clause):
        start = word.end()
        filler = _UNIT_FILLER.match(rest, start)
        unit, spelling = _longest_unit(rest[filler.end() if filler else start :])
        if unit is not None:
            _add_unit(found, number, unit, f"{word[0]} {spelling}")
            return
    if word := _ACCELERATION.search(clause):
        for before in _BEFORE_UNIT.finditer(rest[: word.end() + 60], word.end()):
            if _A_NOTE.search(rest[word.end() : before.start()]):
                return
            unit, spelling = _longest_unit(rest[before.end() :])
            if unit is not None:
                _add_unit(found, number, unit, f"{word[0]} {before[0].strip()} {spelling}")
                return
    for bracket in _BRACKETED.finditer(clause):
        if any(char.isdigit() for char in clause[: bracket.start()][-2:] + clause[bracket.end() :][:2]):
            continue
        unit = unit_of(bracket[1])
        if unit is not None and unit.quantity == vocabulary.ACCELERATION:
            found.bracketed.append((number, unit, bracket[0]))


def _add_unit(found: Statements, number: int, unit: Unit, phrase: str) -> None:
    if not any(line == number and other == unit for line, other, _ in found.units):
        found.units.append((number, unit, phrase))


def _longest_unit(text: str) -> tuple[Unit | None, str]:
    """Return the unit that a text begins with, in its longest reading that is one."""
    text = text[:50]
    ends = [match.start() for match in re.finditer(r"[\s,;:)\](=]|\.(?=\s|$)|$", text)]
    for end in reversed(ends):
        spelling = text[:end].strip()
        if not spelling:
            continue
        unit = unit_of(spelling)
        if unit is not None:
            return unit, spelling
    return None, ""
