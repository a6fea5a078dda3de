// Units: the one place where the numbers of the page turn from those it is sent in into those a reader wants.

// Sent are g, kN, mm and m; each is a kind of quantity, with the SI value of every unit that it may stand in.
const KINDS = {
  acceleration: { title: "Acceleration", units: { g: 9.80665, "m/s²": 1, "%\u00a0g": 0.0980665 } },
  force: { title: "Force", units: { kN: 1e3, MN: 1e6, N: 1 } },
  length: { title: "Length", units: { mm: 1e-3, m: 1 } },
};
const USUAL_UNITS = Object.fromEntries(Object.entries(KINDS).map(([kind, { units }]) => [kind, Object.keys(units)[0]]));
const chosenUnits = { ...USUAL_UNITS };

function kindOf(sent) {
  return Object.keys(KINDS).find((kind) => sent in KINDS[kind].units);
}

// The unit in which a quantity is shown that was sent in this one; of no kind, as it was sent.
function unitFor(sent) {
  const kind = kindOf(sent);
  return kind ? chosenUnits[kind] : sent;
}

function factorFor(sent) {
  const kind = kindOf(sent);
  return kind ? KINDS[kind].units[sent] / KINDS[kind].units[chosenUnits[kind]] : 1;
}

function shownIn(value, sent) {
  return value === null || value === undefined ? value : value * factorFor(sent);
}

// Back to the unit it is sent in; the twelve digits kept are more than any control gives.
function sentFrom(value, sent) {
  const factor = factorFor(sent);
  return factor === 1 ? value : Number((value / factor).toPrecision(12));
}

function allShownIn(values, sent) {
  const factor = factorFor(sent);
  return factor === 1 ? values : values.map((v) => v * factor);
}

// In an address ² has no place, and blanks are signs.
const SPELT = { "m/s²": "m/s2", "%\u00a0g": "%g" };

function unitsFrom(told) {
  for (const [kind, { units }] of Object.entries(KINDS)) {
    const given = told.get(kind);
    chosenUnits[kind] = Object.keys(units).find((unit) => (SPELT[unit] ?? unit) === given) ?? USUAL_UNITS[kind];
  }
}

function unitsInto(told) {
  for (const [kind, unit] of Object.entries(chosenUnits)) if (unit !== USUAL_UNITS[kind]) told[kind] = SPELT[unit] ?? unit;
}
