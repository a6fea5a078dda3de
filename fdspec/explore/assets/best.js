// The best pretension: that of the cube's grid at once, and the one between on request to the server.

const searched = new Map();

function searchKey(s, k, t) {
  return [k, s.ratio, about.indices[s.index].name, t].join(" ");
}

// What was searched at a period: pretension, start, end and value; undefined where nothing was.
function searchedAt(s, k, t) {
  const told = searched.get(searchKey(s, k, t));
  if (!told) return undefined;
  const value = shownIn(told.value, about.indices[s.index].sent);
  return { ...Object.fromEntries(["pretension", "start", "end"].map((name) => [name, shownIn(told[name], "kN")])), value };
}

function searchedEverywhere(s, k) {
  return AXES.period.every((_, t) => searchedAt(s, k, t));
}

// One period, or all of them.
async function search(s, k, t) {
  const from = t ?? 0, count = t === undefined ? SIZES.period : 1;
  const at = { ...s }, index = about.indices[at.index];
  if (Array.from({ length: count }, (_, n) => searchedAt(at, k, from + n)).every(Boolean)) return;
  const period = t === undefined ? "" : `&period=${t}`;
  const { arrays } = unpack(await ask(`best?record=${k}&stiffness_ratio=${at.ratio}&index=${index.name}${period}`));
  for (let n = 0; n < count; n++) {
    const told = Object.fromEntries(Object.entries(arrays).map(([name, values]) => [name, values[n]]));
    searched.set(searchKey(at, k, from + n), told);
  }
}

function gridBest(s, index, numbers, t) {
  const places = numbers[`best ${index.name}`];
  const f = places ? places[s.ratio * SIZES.period + t] : NaN;
  return Number.isFinite(f) ? f : null;
}

// Period, pretension and index at each period: searched where all periods were, else the grid's.
function bestLine(s, index, numbers, k) {
  const line = { x: [], y: [], z: [] };
  const between = searchedEverywhere(s, k);
  for (let t = 0; index.best && t < SIZES.period; t++) {
    const f = gridBest(s, index, numbers, t), told = between ? searchedAt(s, k, t) : null;
    if (told ? !Number.isFinite(told.value) : f === null) continue;
    line.x.push(AXES.period[t]);
    line.y.push(told ? told.pretension : AXES.pretension[f]);
    line.z.push(told ? told.value : cell(numbers[index.name], s.ratio, f, t));
  }
  return line;
}
