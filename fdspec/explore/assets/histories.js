// Histories: asked for when the point moves, one question a record under way at most.

const running = new Map();

// Where the point is one of the cube's its positions are asked for, else its values.
function historyAddress(s, k, file) {
  if (s.free) return `point?${new URLSearchParams({ record: k, ...frameOf(k), ...s.free, pretension: sentFrom(s.free.pretension, "kN") })}`;
  return `${file}?record=${k}&stiffness_ratio=${s.ratio}&pretension=${s.force}&period=${s.period}`;
}

// The history of the point under a record; null when a later question has taken its place.
async function askHistory(s, k, slot) {
  running.get(slot)?.abort();
  const asked = new AbortController();
  running.set(slot, asked);
  try {
    const history = historyInUnits(unpack(await ask(historyAddress(s, k, "history"), asked.signal)));
    return running.get(slot) === asked ? history : null;
  } catch (error) {
    if (error.name === "AbortError") return null;
    throw error;
  }
}

// What is sent of a history, and in which unit: the counterpart of fdspec/explore/traces.py.
const TRACES = {
  displacement: "mm", brace_displacement: "mm", bare_displacement: "mm", friction_force: "kN", acceleration: "g", bare_acceleration: "g",
  ground_acceleration: "g", loop_slip: "mm", loop_force: "kN",
};

function historyInUnits(sent) {
  const arrays = { ...sent.arrays };
  for (const [name, unit] of Object.entries(TRACES)) arrays[name] = allShownIn(arrays[name], unit);
  const compared = sent.compared.map((one) => ({ ...one, unit: unitFor(one.unit), history: shownIn(one.history, one.unit), cube: shownIn(one.cube, one.unit) }));
  return { ...sent, arrays, compared, slip_force: shownIn(sent.slip_force, "kN") };
}
