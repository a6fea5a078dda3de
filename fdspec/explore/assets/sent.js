// What the page was sent: unpacked from bytes, and written for people.

const about = JSON.parse(document.getElementById("about").textContent);

// The counterpart of fdspec/explore/packing.py.
function unpack(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const values = new Float64Array(buffer, 4 + length);
  const arrays = {};
  for (const [name, [first, count]] of Object.entries(head.arrays)) {
    arrays[name] = values.subarray(first, first + count);
  }
  return { ...head, arrays };
}

async function gunzip(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

// What the server answers, or the sentence with which it refuses.
async function ask(address, signal) {
  let answer;
  try {
    answer = await fetch(address, { signal });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Error("The server does not answer: fdspec explore has ended. Start it again and reload this page.");
  }
  if (answer.ok) return answer.arrayBuffer();
  const told = await answer.json().catch(() => ({}));
  throw new Error(told.error || `The server answers with error ${answer.status}.`);
}

async function recordBytes(k) {
  const here = document.getElementById(`record-${k}`);
  return here ? Uint8Array.from(atob(here.textContent), (letter) => letter.charCodeAt(0)) : ask(`record/${k}`);
}

const records = new Map();
function sentNumbers(k) {
  if (!records.has(k)) {
    const coming = recordBytes(k).then(gunzip).then((buffer) => unpack(buffer).arrays);
    coming.catch(() => records.delete(k));
    records.set(k, coming);
  }
  return records.get(k);
}

// 0.11 MN, not 0.11000000000000001.
function shortest(value) {
  return Number(value.toPrecision(15));
}

function nearest(axis, value) {
  let best = 0;
  axis.forEach((x, k) => { if (Math.abs(x - value) < Math.abs(axis[best] - value)) best = k; });
  return best;
}

function written(value, unit) {
  if (typeof value === "string") return value;
  if (value === null || value === undefined || !Number.isFinite(value)) return "unknown";
  const bare = Number.isInteger(value) && Math.abs(value) < 1e6 ? String(value) : String(Number(value.toPrecision(4)));
  // Thousands stand apart from five digits on.
  const digits = /^-?\d{5,}$/.test(bare) ? bare.replace(/\B(?=(\d{3})+$)/g, "\u202f") : bare;
  return unit ? `${digits}\u00a0${unit}` : digits;
}
