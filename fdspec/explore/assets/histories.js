// Histories: asked for when the point moves, one question a record under way at most.

const running = new Map();

// Where the point is one of the cube's its positions are asked for, else its values.
function historyAddress(s, k, file) {
  if (s.free) return `point?${new URLSearchParams({ record: k, ...s.free })}`;
  return `${file}?record=${k}&stiffness_ratio=${s.ratio}&pretension=${s.force}&period=${s.period}`;
}

// The history of the point under a record; null when a later question has taken its place.
async function askHistory(s, k, slot) {
  running.get(slot)?.abort();
  const asked = new AbortController();
  running.set(slot, asked);
  try {
    const history = unpack(await ask(historyAddress(s, k, "history"), asked.signal));
    return running.get(slot) === asked ? history : null;
  } catch (error) {
    if (error.name === "AbortError") return null;
    throw error;
  }
}
