"""What the words of a heading mean: quantities in English and the commonest other languages.

Words are compared without case and accents. Long stems match the words that begin with them, so that
"accelerazione" and a misspelt "accelaration" are both found under "accel"; short ones, and those listed
with a full stop, match whole words.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from types import MappingProxyType
from typing import Final

TIME: Final = "time"
ACCELERATION: Final = "acceleration"
VELOCITY: Final = "velocity"
DISPLACEMENT: Final = "displacement"
PERIOD: Final = "period"
FREQUENCY: Final = "frequency"
SPECTRAL: Final = "spectral amplitude"
SAMPLE: Final = "sample number"
OTHER: Final = "another quantity"
DIRECTION: Final = "direction"
UNKNOWN: Final = "unknown"

_STEM: Final = 4
"""Letters from which a word stands for all that begin with it."""

_WORDS: Final = {
    # Before acceleration, for these qualify it into something else.
    SPECTRAL: """
        spectr spektr spettr espectr spectra sa sv sd psa psv psd_ pseudo fourier fft fas psd ductil duct
        duktil ordinat elastic inelastic elastisch elastico elastique damping damped dampf amortig amortis
        smorz zeta спектр φασμ 谱 譜 スペクトル 응답스펙트럼
    """,
    OTHER: """
        peak max maxim maximum min minim minimum pga pgv pgd rms mean average avg std sigma deviation error
        integrated integral cumul squared square abs magnitude resultant norm vector srss envelope target
        window weight gyro angul rotation rotat rot winkel torsion angle jerk temperature temp. humidity
        pressure force moment strain stress voltage volt counts count/ energy arias husid power drift
        response residual difference intensity coherence phase damage battery date clock latitude longitude
        lat lon lat/lon depth distance magnitud kraft temperatur spannung fuerza temperatura forza pression
        sicaklik kuvvet 角速度 角加速度 温度 压力 圧力 力 最大 温 気温 累積 电压 電圧
        температур давлен сил максимал
    """,
    PERIOD: "period periode periodo periyo peryod период περιοδ perioda okres periodos 周期 주기",
    FREQUENCY: """
        freq frequ frequenz frequence frequency frecuencia frequenza frekans frekv frekvens czestot частот
        συχνοτ omega 频率 頻率 周波数 振動数 주파수
    """,
    SAMPLE: """
        sample samples index idx no nr num number count point points pt row rows id step steps record scan
        frame line muestra campione echantillon ornek numero nummer sira probe abtastwert amostra номер № #
        序号 序號 番号 编号 编号 点号 번호
    """,
    ACCELERATION: """
        accel acc accn acce accl acel acele aceler acelera beschl beschleunigung ivme versnel przysp zrychl
        gyorsul percepat ускор επιταχ ubrzan kiihty akseler aksel accler accelero
        acceler acceleration 加速度 가속도
    """,
    VELOCITY: """
        vel veloc velo speed geschw geschwindigkeit vites vitesse hiz snelh predkosc rychlost sebess kecepat
        скорост ταχυτ hastig brzin nopeu 速度 속도
    """,
    DISPLACEMENT: """
        disp displ dis dspl desplaz deplac spost verschieb weg desloc yerdegis deplasman verplaats przemieszcz
        posun elmozd perpindah перемещ смещ μετατοπ μετακιν forskyd forskjut siirtym pomak
        位移 変位 變位 변위
    """,
    TIME: """
        time times zeit zeiten temps tempo tiempo zaman sure tid tijd cas czas ido waktu timp aika vreme
        vrijeme время χρονος elapsed seconds sekunden sekunde secondi segundos secondes second saniye
        时间 時間 时刻 時刻 시간
    """,
}  # fmt: skip

_DIRECTIONS: Final = """
    ns ew ud sn we du n e z s w u v l t r h x y n-s e-w u-d up down updown vert verti vertical vertikal
    verticale verticaal north south east west norte este sur oeste nord sud est ouest ost suden norden osten
    westen ovest kuzey guney dogu bati dusey boyuna enine long longi longitudinal trans transv transversal
    transverse radial tangential tang horiz horizontal hor lateral ch chan channel canal canale kanal kanaal
    comp component componente composante komponente bilesen deg degree degrees grad azimuth fn fp sensor
    axis achse eje asse ground base roof floor boden sol suelo zemin strong motion data value values wert
    werte valeur valor valore raw filtered corrected uncorrected corr uncorr korrigiert corregida corrigee
    corretta duzeltilmis recorded input signal of the der di de du des d la le el in at station site
    北 南 東 西 东 上 下 垂直 水平 方向 成分 鉛直 竖向 南北 東西 东西 上下 분
"""

AXIS: Final = r"(?:x|y|z|n|e|u|v|l|t|r|h|1|2|3|ns|ew|ud|up|h1|h2|lon|tra|ver)"
_AZIMUTH: Final = re.compile(
    r"(?:[ns]\d{1,2}[ew]?|\d{1,3}|(?:ch|hn|bn|en|hl|bh|hh)[a-z0-9]{1,2})(?:deg)?", re.ASCII
)


def plain(text: str) -> str:
    """Return text in lower case, without accents, with compatibility characters resolved (m/s² to m/s2)."""
    decomposed = unicodedata.normalize("NFKD", text.replace("ı", "i").replace("İ", "i").casefold())
    return "".join(char for char in decomposed if not unicodedata.combining(char))


def _listed(words: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(plain(word) for word in words.split()))


_LISTS: Final = MappingProxyType({quantity: _listed(words) for quantity, words in _WORDS.items()})
_DIRECTION_WORDS: Final = frozenset(_listed(_DIRECTIONS))


def _is_alphabetic(word: str) -> bool:
    """Say whether a word's script puts blanks between words; Chinese and Japanese do not."""
    return all(ord(char) < 0x2E80 for char in word)


def _exact_and_stems(words: Iterable[str]) -> tuple[frozenset[str], tuple[str, ...], tuple[str, ...]]:
    alphabetic = [word for word in words if _is_alphabetic(word)]
    return (
        frozenset(word.rstrip(".") for word in alphabetic),
        tuple(word for word in alphabetic if len(word) >= _STEM and not word.endswith(".")),
        tuple(word for word in words if not _is_alphabetic(word)),
    )


_MATCHERS: Final = MappingProxyType({q: _exact_and_stems(words) for q, words in _LISTS.items()})
_FOREIGN: Final = tuple(
    word for words in _LISTS.values() for word in words if not word.isascii() and len(word) >= 2
) + tuple(word for word in _DIRECTION_WORDS if not word.isascii() and len(word) >= 2)
_TOKEN: Final = re.compile(r"[^\W_]+|[#№]")
_HUMP: Final = re.compile(r"(?<=[a-z])(?=[A-Z])|(?<=[a-zA-Z]{3})(?=\d)")


def has_known_word(text: str) -> bool:
    """Say whether a word of a script other than Latin stands in the text."""
    words = plain(text)
    return any(word in words for word in _FOREIGN)


def tokens(text: str) -> list[str]:
    """Return the words of a text, plain; humps (AccNS) and trailing numbers (Acc1) are parted."""
    return _TOKEN.findall(plain(_HUMP.sub(" ", text[:300])))


def _is(word: str, quantity: str) -> bool:
    exact, stems, inside = _MATCHERS[quantity]
    if word in exact or any(word.startswith(stem) for stem in stems):
        return True
    return any(part in word for part in inside)


def quantity_of(text: str) -> str:
    """Return the quantity that words name, by the first that applies; DIRECTION, UNKNOWN when none does.

    "Spectral acceleration" is a spectral amplitude, "acceleration time history" an acceleration, "time step"
    a sample number.
    """
    words = tokens(text)
    for quantity in (SPECTRAL, OTHER, PERIOD, FREQUENCY):
        if any(_is(word, quantity) for word in words):
            return quantity
    for quantity in (ACCELERATION, VELOCITY, DISPLACEMENT):
        if any(_is(word, quantity) for word in words):
            return quantity
    timed = any(_is(word, TIME) for word in words)
    counted = any(_is(word, SAMPLE) for word in words)
    if timed and counted:  # "sample time" and "time of sample" are times, a "time step" counts
        return SAMPLE if set(words) & {"step", "steps", "index", "number", "no", "count"} else TIME
    if timed:
        return TIME
    if counted:
        return SAMPLE
    return DIRECTION if words and all(is_direction(word) for word in words) else UNKNOWN


def is_direction(word: str) -> bool:
    """Say whether a word names a direction, a channel or says nothing about the quantity."""
    return word in _DIRECTION_WORDS or _AZIMUTH.fullmatch(word) is not None


def mentions(text: str, quantity: str) -> bool:
    """Say whether any word of a text names this quantity, whatever others do."""
    return any(_is(word, quantity) for word in tokens(text))
