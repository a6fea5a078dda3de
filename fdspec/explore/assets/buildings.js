// The page of a cube of buildings: profiles over the height, and what the factors on the dampers change.

const AXES = about.axes;
const control = Object.fromEntries(["building", "record", "quantity", "stiffness", "slip", "intensity"].map((id) => [id, byId(id)]));
// Slider -> axis of the cube, and the words for it.
const SLIDERS = { stiffness: ["stiffness_scale", "brace stiffness times"], slip: ["slip_scale", "slip forces times"], intensity: ["intensity", "ground motion times"] };

for (const quantity of about.quantities) quantity.sent = quantity.unit;
function applyUnits() {
  for (const quantity of about.quantities) quantity.unit = unitFor(quantity.sent);
}

const USUAL = {
  building: 0, record: -1, quantity: 0,
  stiffness: nearest(AXES.stiffness_scale, 1), slip: nearest(AXES.slip_scale, 1), intensity: nearest(AXES.intensity, 1),
};
const state = fromAddress();

function fromAddress() {
  const told = new URLSearchParams(location.hash.slice(1)), found = { ...USUAL };
  unitsFrom(told);
  applyUnits();
  const place = (name, list) => { const k = list.indexOf(told.get(name)); if (k >= 0) found[name] = k; };
  place("building", AXES.building);
  place("record", about.records.map((r) => r.name));
  place("quantity", about.quantities.map((q) => q.name));
  for (const [name, [axis]] of Object.entries(SLIDERS)) {
    const value = numberOf(told.get(axis));
    if (value !== null) found[name] = nearest(AXES[axis], value);
  }
  return found;
}

function addressOf(s) {
  const told = { building: AXES.building[s.building], quantity: about.quantities[s.quantity].name };
  if (s.record >= 0) told.record = about.records[s.record].name;
  for (const [name, [axis]] of Object.entries(SLIDERS)) if (AXES[axis].length > 1) told[axis] = AXES[axis][s[name]];
  unitsInto(told);
  return "#" + new URLSearchParams(told);
}

function readAddress() {
  Object.assign(state, fromAddress());
  show();
}

// ---- numbers: a quantity of a record over the storeys, in the units of the page; null where there is no number

function overHeight(numbers, quantity, s) {
  const count = AXES.storey.length, factor = factorFor(quantity.sent);
  const first = (((s.building * AXES.stiffness_scale.length + s.stiffness) * AXES.slip_scale.length + s.slip) * AXES.intensity.length + s.intensity) * count;
  return Array.from(numbers[quantity.name].subarray(first, first + count), (v) => (Number.isFinite(v) ? v * factor : null));
}

// Of the records that have a number: a share of them lies below this.
function said(values, share) {
  const known = values.filter((v) => v !== null);
  return known.length ? quantile(known, share) : null;
}

// A floor's peak stands at its height, a storey's halfway up; the ground is 0.
function heightsOf(quantity) {
  return AXES.storey.map((storey) => (quantity.floor ? storey : storey - 0.5));
}

function largest(values) {
  const known = values.filter((v) => v !== null);
  return known.length ? Math.max(...known) : null;
}

// ---- pictures

function designWords(s) {
  const factors = Object.entries(SLIDERS).filter(([name, [axis]]) => name !== "intensity" || AXES[axis].length > 1);
  return [AXES.building[s.building], ...factors.map(([name, [axis, words]]) => `${words} ${written(AXES[axis][s[name]])}`)].join(", ");
}

// Places of storeys, frame by frame: a storey that does not stand on the one before it begins another, and no line joins them.
function framesOf(s) {
  const standsOn = about.stands_on ? about.stands_on[s.building] : AXES.storey.map((storey) => storey - 1);
  const frames = [];
  for (const [k, storey] of AXES.storey.entries()) {
    if (frames.length === 0 || standsOn[k] !== storey - 1) frames.push([]);
    frames.at(-1).push(k);
  }
  return frames;
}

function profilePlot(s, quantity, everything) {
  const lines = everything.map(({ numbers }) => overHeight(numbers, quantity, s)), y = heightsOf(quantity);
  const over = (share) => y.map((_, k) => said(lines.map((line) => line[k]), share));
  const hover = (name) => `%{x:.4g} ${quantity.unit}, storey %{customdata}<extra>${name}</extra>`;
  const frames = framesOf(s), data = [];
  const line = (frame, name, x, look, more) => {
    const of = (values) => frame.map((k) => values[k]);
    const { showlegend = false, ...others } = more ?? {};
    data.push({
      type: "scatter", mode: "lines", name, x: of(x), y: of(y), customdata: of(AXES.storey), line: look, hovertemplate: hover(name),
      legendgroup: name, showlegend: showlegend && frame === frames[0], ...others,
    });
  };
  for (const frame of frames) for (const [k, x] of lines.entries()) line(frame, plain(everything[k].name), x, { color: LOOK.grey, width: 1 });
  for (const frame of frames) {
    if (lines.length > 1) {
      line(frame, "16 %", over(0.16), { color: FLOOR, width: 0 }, { hoverinfo: "skip" });
      line(frame, "16 to 84 %", over(0.84), { color: FLOOR, width: 0 }, { fill: "tonextx", fillcolor: `${FLOOR}33`, showlegend: true, hoverinfo: "skip" });
    }
    line(frame, "median", over(0.5), { color: FLOOR, width: 2.4 }, { mode: "lines+markers", marker: { color: FLOOR, size: 6 }, showlegend: true });
    if (s.record >= 0) line(frame, plain(about.records[s.record].name), lines[s.record], { color: BRACE, width: 2, dash: "dash" }, { showlegend: true });
  }
  const top = AXES.storey.at(-1);
  return {
    data,
    layout: layout({
      showlegend: true, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 }, margin: { l: 48, r: 12, t: 30, b: 42 },
      xaxis: axis(`${quantity.title.toLowerCase()}${unitOf(quantity)}`, { rangemode: "tozero", nticks: 6 }),
      yaxis: axis("storey", { range: [0, top + 0.6], tickvals: AXES.storey.filter((_, k) => top <= 12 || k % Math.ceil(top / 12) === 0) }),
    }),
  };
}

// The worst storey over the factor on the slip forces.
function slipPlot(s, quantity, everything) {
  const x = AXES.slip_scale;
  const lines = everything.map(({ numbers }) => x.map((_, slip) => largest(overHeight(numbers, quantity, { ...s, slip }))));
  const over = (share) => x.map((_, k) => said(lines.map((line) => line[k]), share));
  const line = (name, y, look, more) => ({ type: "scatter", mode: "lines", name, x, y, line: look, showlegend: false, hovertemplate: `times %{x:.4g}: %{y:.4g} ${quantity.unit}<extra>${name}</extra>`, ...more });
  const data = lines.map((y, k) => line(plain(everything[k].name), y, { color: LOOK.grey, width: 1 }));
  data.push(line("median", over(0.5), { color: LOOK.median, width: 2.4 }, { showlegend: true }));
  data.push(line("84 %", over(0.84), { color: LOOK.high, width: 2.4, dash: "dash" }, { showlegend: true }));
  if (s.record >= 0) data.push(line(plain(about.records[s.record].name), lines[s.record], { color: BRACE, width: 2, dash: "dash" }, { showlegend: true }));
  return {
    data,
    layout: layout({
      showlegend: true, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 }, margin: { l: 58, r: 12, t: 30, b: 42 },
      xaxis: axis("factor on the slip forces"), yaxis: axis(folded(`${quantity.title}, worst storey${unitOf(quantity)}`), { rangemode: "tozero", automargin: true }),
      shapes: [{ type: "line", x0: x[s.slip], x1: x[s.slip], y0: 0, y1: 1, yref: "paper", line: { color: LIMIT, width: 1, dash: "dot" } }],
    }),
  };
}

function missingWords(lines) {
  const missing = lines.filter((line) => line.every((v) => v === null)).length;
  return missing ? ` ${missing} of ${lines.length} histories did not end well and are left out.` : "";
}

function profileWords(s, quantity, everything) {
  const lines = everything.map(({ numbers }) => overHeight(numbers, quantity, s));
  const medians = AXES.storey.map((_, k) => said(lines.map((line) => line[k]), 0.5)), most = largest(medians);
  if (most === null) return "No history ended well here.";
  return `The median is largest in storey ${AXES.storey[medians.indexOf(most)]}: ${written(most, quantity.unit)}.${missingWords(lines)}`;
}

function profilePicture(quantity, everything) {
  return {
    id: `profile-${quantity.name}`, place: "maps", look: "profile",
    plot: () => profilePlot(state, quantity, everything),
    title: () => `${quantity.title}${unitOf(quantity)}: ${designWords(state)}`,
    words: () => [element("div", profileWords(state, quantity, everything))],
    origin: () => `Records: ${everything.map(({ name }) => name).join(", ")}`,
    file: () => fileName(AXES.building[state.building], quantity.name, `slip${AXES.slip_scale[state.slip]}`, `stiffness${AXES.stiffness_scale[state.stiffness]}`),
    numbers: () => profileNumbers(state, quantity, everything),
  };
}

function profileNumbers(s, quantity, everything) {
  const lines = everything.map(({ numbers }) => overHeight(numbers, quantity, s));
  const heads = ["storey", ...everything.map(({ name }) => `${name}_${named(quantity)}`), "percentile_16", "median", "percentile_84"];
  const rows = AXES.storey.map((storey, k) => {
    const column = lines.map((line) => line[k]);
    return [storey, ...column, ...[0.16, 0.5, 0.84].map((share) => said(column, share))];
  });
  return { heads, rows };
}

function slipPicture(everything) {
  const quantity = about.quantities[state.quantity];
  const numbers = () => ({
    heads: ["slip_scale", ...everything.map(({ name }) => `${name}_${named(quantity)}`)],
    rows: AXES.slip_scale.map((scale, slip) => [scale, ...everything.map((one) => largest(overHeight(one.numbers, quantity, { ...state, slip })))]),
  });
  return {
    id: "over-slip", place: "curves", look: "curve", numbers,
    plot: () => slipPlot(state, quantity, everything),
    title: () => `${quantity.title} of the worst storey over the slip forces: ${AXES.building[state.building]}, ${SLIDERS.stiffness[1]} ${written(AXES.stiffness_scale[state.stiffness])}`,
    words: () => [element("div", slipWords(state, quantity, everything))],
    origin: () => `Records: ${everything.map(({ name }) => name).join(", ")}`,
    file: () => fileName(AXES.building[state.building], quantity.name, "over-slip"),
    click: (point) => { chosen = true; state.slip = nearest(AXES.slip_scale, point.x); show(); },
  };
}

function slipWords(s, quantity, everything) {
  const medians = AXES.slip_scale.map((_, slip) => said(everything.map(({ numbers }) => largest(overHeight(numbers, quantity, { ...s, slip }))), 0.5));
  const known = medians.filter((v) => v !== null);
  if (!known.length) return "No history ended well here.";
  const least = Math.min(...known);
  return `The median of the worst storey is least at slip forces times ${written(AXES.slip_scale[medians.indexOf(least)])}: ${written(least, quantity.unit)}. ` +
    `Here, times ${written(AXES.slip_scale[s.slip])}, it is ${written(medians[s.slip], quantity.unit)}.`;
}

// ---- drawing

async function show() {
  const turn = ++asked;
  byId("pictures").setAttribute("aria-busy", "true");
  controlsFromState();
  try {
    const everything = await Promise.all(about.records.map(async (r, k) => ({ k, name: r.name, numbers: (await sentNumbers(k)) })));
    if (turn !== asked) return;
    toAddress();
    for (const quantity of about.quantities) {
      await draw(profilePicture(quantity, everything));
      if (turn !== asked) return;
    }
    if (AXES.slip_scale.length > 1) await draw(slipPicture(everything));
    tables(everything);
  } catch (error) {
    complain(error);
  } finally {
    if (turn === asked) byId("pictures").setAttribute("aria-busy", "false");
  }
}

function tables(everything) {
  const open = new Set(Array.from(byId("more").querySelectorAll("details[open]"), (d) => d.id));
  const block = (id, summary, content) => {
    const made = element("details");
    made.id = id;
    made.open = open.has(id);
    made.append(element("summary", summary), content);
    return made;
  };
  const rows = [...AXES.storey.keys()].reverse().map((k) => [String(AXES.storey[k]), ...about.quantities.map((quantity) =>
    written(said(everything.map(({ numbers }) => overHeight(numbers, quantity, state)[k]), 0.5), quantity.unit))]);
  const list = element("dl");
  for (const { k, name } of everything) list.append(element("dt", name), element("dd", originWords(k)));
  for (const cube of about.cubes) {
    for (const [term, text] of [["Cube", [cube.name, cube.title].filter(Boolean).join(": ")], ["Made", cube.made], ["Note", cube.comment]]) {
      if (text) list.append(element("dt", term), element("dd", text));
    }
  }
  byId("more").replaceChildren(
    block("medians", "Medians of all storeys, as a table", table(`Medians over the records: ${designWords(state)}`, ["Storey", ...about.quantities.map((q) => q.title)], rows)),
    block("origin-of-numbers", "Where the numbers come from", list),
  );
}

// ---- controls

function controlsFromState() {
  for (const name of ["building", "record", "quantity"]) control[name].value = String(state[name]);
  for (const [name, [axis]] of Object.entries(SLIDERS)) {
    const told = written(AXES[axis][state[name]]);
    control[name].value = String(state[name]);
    control[name].setAttribute("aria-valuetext", told);
    byId(`${name}-value`).textContent = told;
  }
  unitsFromState();
}

function connect() {
  const count = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;
  byId("name").textContent = about.name;
  byId("maps").setAttribute("aria-label", "Profiles over the height");
  byId("curves").setAttribute("aria-label", "Over the factor on the slip forces");
  byId("origin").textContent = [count(about.records.length, "record"), count(AXES.building.length, "building"), count(AXES.storey.length, "storey"),
    count(AXES.stiffness_scale.length, "factor") + " on brace stiffness", count(AXES.slip_scale.length, "factor") + " on slip forces"].join(", ") + `. ${about.cubes[0].title}.`;
  options(control.building, AXES.building);
  options(control.record, ["none", ...about.records.map((r) => r.name)], -1);
  options(control.quantity, about.quantities.map((quantity) => quantity.title));
  for (const [name, [axis]] of Object.entries(SLIDERS)) {
    control[name].max = String(AXES[axis].length - 1);
    control[name].disabled = AXES[axis].length === 1;
    control[name].addEventListener("input", () => { state[name] = Number(control[name].value); show(); });
  }
  byId("intensity-field").hidden = AXES.intensity.length === 1;
  for (const name of ["building", "record", "quantity"]) {
    control[name].addEventListener("change", () => { chosen = true; state[name] = Number(control[name].value); show(); });
  }
  connectPage();
}

start();
