// Numbers of a cube of single-storey frames: in the units of the page, sliced, and on a scale of colours.

const AXES = { ...about.axes };
const SIZES = { ratio: AXES.stiffness_ratio.length, force: AXES.pretension.length, period: AXES.period.length };

// A record's numbers in the units of the page, kept until those change.
const inUnits = new Map();
function recordNumbers(k) {
  if (!inUnits.has(k)) {
    const coming = sentNumbers(k).then((arrays) => {
      const shown = { ...arrays };
      for (const index of about.indices) shown[index.name] = allShownIn(arrays[index.name], index.sent);
      for (const name of ["bare", "braced"]) if (name in arrays) shown[name] = allShownIn(arrays[name], "g");
      return shown;
    });
    coming.catch(() => inUnits.delete(k));
    inUnits.set(k, coming);
  }
  return inUnits.get(k);
}

for (const index of about.indices) index.sent = index.unit;

// Everything that stands in a unit, in those chosen now.
let FORCE, LENGTH, ACCELERATION;
function applyUnits() {
  inUnits.clear();
  [FORCE, LENGTH, ACCELERATION] = ["kN", "mm", "g"].map(unitFor);
  for (const name of ["pretension", "slip_force"]) AXES[name] = about.axes[name].map((v) => shortest(shownIn(v, "kN")));
  for (const index of about.indices) index.unit = unitFor(index.sent);
  FIELDS.find((field) => field.name === "pretension").unit = FORCE;
}

// The numbers that the page has a field for; those of the frame hold for the whole cube.
const FIELDS = [
  { name: "period", title: "period", unit: "s" }, { name: "stiffness_ratio", title: "stiffness ratio", unit: "" }, { name: "pretension", title: "pretension", unit: "kN" },
  ...["floor_mass", "brace_mass", "damping_ratio", "friction_coefficient"].flatMap((name) => {
    const told = about.cubes[0].frame.find((one) => one.name === name);
    return told ? [{ name, title: told.title, unit: told.unit, own: true }] : [];
  }),
];
applyUnits();

// Values of the point: the cube's at the sliders, or those that were typed.
function pointOf(s) {
  const here = { period: AXES.period[s.period], stiffness_ratio: AXES.stiffness_ratio[s.ratio], pretension: s.force === null ? NaN : AXES.pretension[s.force] };
  return { ...here, ...frameOf(s.record), ...(s.free || {}) };
}

// The frame's constants in the cube that a record is of.
function frameOf(k) {
  const { frame } = about.cubes[about.records[k].cube];
  return Object.fromEntries(FIELDS.filter((field) => field.own).map(({ name }) => [name, frame.find((one) => one.name === name)?.value]));
}

// A point between the cube's: its place, and of the frame what is not the record's cube's own.
function freeAt(point, k) {
  const own = frameOf(k);
  return Object.fromEntries(Object.entries(point).filter(([name, value]) => !(name in own) || Math.abs(value - own[name]) > 1e-9 * Math.abs(own[name])));
}

function cell(values, ratio, force, period) {
  return values[(ratio * SIZES.force + force) * SIZES.period + period];
}

// Rows over period, one a pretension; null where there is no number, which leaves a gap in a picture.
function slice(values, ratio) {
  const rows = [];
  for (let f = 0; f < SIZES.force; f++) {
    const first = (ratio * SIZES.force + f) * SIZES.period;
    rows.push(Array.from(values.subarray(first, first + SIZES.period), (v) => (Number.isFinite(v) ? v : null)));
  }
  return rows;
}

// Bounds and step of the colours: round numbers, from 0 or below to the largest value, but not beyond [least, most].
// Where there is a neutral value, as far below it as above, and a bound of colour at it.
function scaleOf(arrays, [least, most], neutral = null) {
  let low = 0, high = -Infinity;
  for (const values of arrays) {
    for (const v of values) {
      if (v < low && v > -Infinity) low = v;
      if (v > high && v < Infinity) high = v;
    }
  }
  low = Math.max(low, least ?? -Infinity);
  high = Math.min(high, most ?? Infinity);
  if (!(high > low)) high = low + 1;
  const half = neutral === null ? 0 : Math.max(high - neutral, neutral - low) || 1;
  const rough = half ? half / 9 : (high - low) / 18, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map((m) => m * power).find((m) => m >= rough * 0.999);
  if (half) {
    const steps = Math.ceil(half / step - 1e-9);
    return { low: neutral - steps * step, high: neutral + steps * step, step, neutral };
  }
  return { low: Math.floor(low / step) * step, high: Math.ceil(high / step - 1e-9) * step, step };
}
