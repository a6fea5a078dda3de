// The page of a cube of single-storey frames: its controls, its pictures, and what follows from what.

const control = Object.fromEntries(["record", "compare", "index", "ratio", "period", "force", "best", "line"].map((id) => [id, byId(id)]));

// In an address: compared with no other, where two cubes would be.
const NONE = "none";
const USUAL = {
  record: 0, compare: about.cubes.length > 1 ? counterpart(0) : -1, index: 0, turn: -55, strong: false, free: null,
  ratio: nearest(AXES.stiffness_ratio, 4), period: nearest(AXES.period, 0.5), force: null,
};
const state = fromAddress();

// The same earthquake in the next cube; -1 where it has none.
function counterpart(k) {
  const { record, cube } = about.records[k];
  return about.records.findIndex((r) => r.record === record && r.cube === (cube + 1) % about.cubes.length);
}
const histories = new Map();

// ---- state in the address, by names and values, so that a view can be kept, sent, and gone back to

function fromAddress() {
  const told = new URLSearchParams(location.hash.slice(1)), found = { ...USUAL };
  unitsFrom(told);
  applyUnits();
  const names = about.records.map((r) => r.name);
  const place = (list, name) => list.indexOf(told.get(name));
  if (place(names, "record") >= 0) found.record = place(names, "record");
  if (place(names, "compare") >= 0) found.compare = place(names, "compare");
  else if (told.get("compare") === NONE) found.compare = -1;
  else if (about.cubes.length > 1) found.compare = counterpart(found.record);
  if (place(about.indices.map((index) => index.name), "index") >= 0) found.index = place(about.indices.map((index) => index.name), "index");
  const free = {};
  for (const [key, name] of [["period", "period"], ["ratio", "stiffness_ratio"], ["force", "pretension"]]) {
    const sent = numberOf(told.get(name));
    if (sent === null) continue;
    const value = name === "pretension" ? shortest(shownIn(sent, "kN")) : sent;
    found[key] = nearest(AXES[name], value);
    if (Math.abs(AXES[name][found[key]] - value) > 1e-9 * Math.abs(value)) free[name] = value;
  }
  for (const field of FIELDS.filter((one) => one.own)) {
    const value = numberOf(told.get(field.name));
    if (value !== null && value !== frameOf(found.record)[field.name]) free[field.name] = value;
  }
  if (found.compare === found.record) found.compare = -1;
  if (about.served && Object.keys(free).length) found.free = freeAt({ ...pointOf({ ...found, free: null, force: found.force ?? 0 }), ...free }, found.record);
  return found;
}

function addressOf(s) {
  const at = pointOf(s), told = { record: about.records[s.record].name, index: about.indices[s.index].name };
  if (s.compare >= 0) told.compare = about.records[s.compare].name;
  else if (about.cubes.length > 1) told.compare = NONE;
  for (const name of ["stiffness_ratio", "period", "pretension"]) told[name] = name === "pretension" ? sentFrom(at[name], "kN") : at[name];
  for (const field of FIELDS) if (field.own && s.free && field.name in s.free) told[field.name] = s.free[field.name];
  unitsInto(told);
  return "#" + new URLSearchParams(told);
}

function readAddress() {
  Object.assign(state, fromAddress(), { turn: state.turn, strong: state.strong });
  show();
}

// ---- cards

// Two maps show the same stretch, two surfaces the same side, and the slider of the turn follows.
let linking = false;
async function linked(made, change) {
  if (linking) return;
  linking = true;
  try {
    const kind = made.id.split("-")[0];
    const others = [...cards.values()].filter((one) => one !== made && one.id.split("-")[0] === kind);
    const kept = Object.fromEntries(Object.entries(change).filter(([name]) => /^[xy]axis\.(range|autorange)/.test(name)));
    if (kind === "map" && Object.keys(kept).length) await Promise.all(others.map((one) => Plotly.relayout(one.plotted, kept)));
    const camera = change["scene.camera"];
    if (kind === "surface" && camera) {
      state.turn = Math.round((Math.atan2(camera.eye.y, camera.eye.x) * 180) / Math.PI);
      turnSlider();
      await Promise.all(others.map((one) => Plotly.relayout(one.plotted, { "scene.camera": camera })));
    }
  } finally {
    linking = false;
  }
}

function turnSlider() {
  for (const slider of document.querySelectorAll("input.turn")) {
    slider.value = String(state.turn);
    slider.setAttribute("aria-valuetext", `${state.turn}\u00a0°`);
  }
}

async function turnTo(degrees) {
  state.turn = degrees;
  turnSlider();
  await painted();
  linking = true;
  for (const [id, made] of cards) if (id.startsWith("surface")) await Plotly.relayout(made.plotted, { "scene.camera.eye": eye(state.turn) });
  linking = false;
}

// ---- what is shown

function chosenIndex() {
  return about.indices[state.index];
}

async function shownRecords() {
  const ks = state.compare < 0 ? [state.record] : [state.record, state.compare];
  return Promise.all(ks.map(async (k) => ({ k, numbers: await recordNumbers(k) })));
}

function movePoint(period, pretension) {
  state.free = null;
  chosen = true;
  state.period = nearest(AXES.period, period);
  if (pretension !== null) state.force = nearest(AXES.pretension, pretension);
  show();
}

function mapPicture(n, k, numbers, scale, kind) {
  const index = chosenIndex(), name = about.records[k].name;
  const plot = kind === "map" ? contourPlot : surfacePlot;
  return {
    id: `${kind}-${n}`, place: "maps", look: "map",
    plot: () => plot(state, index, numbers, scale, bestLine(state, index, numbers, k)),
    title: () => `${index.title}${unitOf(index)}: ${name}, stiffness ratio ${written(AXES.stiffness_ratio[state.ratio])}${kind === "map" ? "" : ", as a surface"}`,
    words: () => kind === "map"
      ? [mapWords(state, k, index, numbers) + (index.best ? ` Dots: best pretension at each period${searchedEverywhere(state, k) ? ", searched" : ""}. Cross: the point.` : " Cross: the point.")]
      : ["The numbers of the map beside it, over the same axes."],
    origin: () => originWords(k),
    file: () => fileName(name, index.name, `SR${AXES.stiffness_ratio[state.ratio]}`, kind),
    numbers: () => mapNumbers(state, index, numbers),
    click: (point) => movePoint(point.x, point.y),
    relayed: (change) => linked(cards.get(`${kind}-${n}`), change),
    below: kind === "map" ? undefined : () => [turning(n)],
  };
}

// The slider that turns a surface stands below it.
function turning(n) {
  const field = element("div"), label = element("label", "Turn"), slider = element("input");
  field.className = "turning";
  slider.id = n ? "turn-1" : "turn";
  label.htmlFor = slider.id;
  Object.assign(slider, { type: "range", className: "turn", min: "-180", max: "180", step: "5" });
  slider.value = String(state.turn);
  slider.setAttribute("aria-valuetext", `${state.turn}\u00a0°`);
  slider.addEventListener("input", () => turnTo(Number(slider.value)));
  field.append(label, slider);
  return field;
}

function curvePicture(kind, shown) {
  const index = chosenIndex(), names = shown.map(({ k }) => about.records[k].name);
  const who = names.join(" and "), at = `stiffness ratio ${written(AXES.stiffness_ratio[state.ratio])}`;
  const common = { id: kind, place: "curves", look: "curve", origin: () => shown.map(({ k }) => originWords(k)).join(" | ") };
  if (kind === "over-pretension") {
    return {
      ...common,
      plot: () => slicePlot(state, index, shown),
      title: () => `${index.title} over pretension: ${who}, period ${written(AXES.period[state.period], "s")}, ${at}`,
      words: () => shown.map(({ k, numbers }) => element("div", curveWords(state, k, index, numbers)))
        .concat(element("div", sliceMarks(index))),
      file: () => fileName(...names, index.name, "over-pretension"),
      numbers: () => sliceNumbers(state, index, shown),
      click: (point) => movePoint(AXES.period[state.period], point.x),
    };
  }
  return {
    ...common,
    plot: () => bestPlot(state, index, shown),
    title: () => `Best pretension over period: ${who}, ${at}`,
    words: () => shown.map(({ k, numbers }) => element("div", `${about.records[k].name}: ${bestWords(state, k, index, numbers)}`)),
    file: () => fileName(...names, index.name, "best-pretension"),
    numbers: () => bestNumbers(state, index, shown),
    click: (point) => { state.period = nearest(AXES.period, point.x); chooseBest(); },
  };
}

function historyPicture(n, k, found) {
  const name = about.records[k].name, at = { ...state };
  return {
    id: `history-${n}`, place: "histories", look: "history",
    plot: () => historyPlot(found, byId("histories").clientWidth < 700, state.strong ? strongMotion(found.arrays) : null),
    title: () => `History: ${name}, ${pointWords(at)}`,
    words: () => [element("div", `${historyWords(found)} Choose the bare frame in the legend to lay it under the floor.`), ...(found.notice ? [notice(found.notice)] : [])],
    origin: () => originWords(k),
    file: () => { const p = pointOf(at); return fileName(name, "history", `T${p.period}`, `SR${p.stiffness_ratio}`, `${p.pretension}${FORCE}`); },
    numbers: () => historyNumbers(found),
    netcdf: async () => {
      const now = cards.get(`history-${n}`);
      if (now.at.free) throw new Error("A point between the cube's has no netCDF here; fdspec simulate writes it.");
      download(`${now.file()}.nc`, await ask(historyAddress(now.at, now.k, "history.nc")), "application/x-netcdf");
    },
    at, k,
  };
}

function energyPicture(n, k, found) {
  const name = about.records[k].name, at = { ...state };
  return {
    id: `energy-${n}`, place: "curves", look: "curve",
    plot: () => energyPlot(found),
    title: () => `Energy: ${name}, ${pointWords(at)}`,
    words: () => {
      const last = (of) => found.arrays[of].at(-1);
      return [element("div", `Of ${written(last("input_energy"), "kJ")} that the ground put in, friction took ${written(last("friction_energy"), "kJ")} and viscous damping ${written(last("viscous_energy"), "kJ")}.`)];
    },
    origin: () => originWords(k),
    file: () => fileName(name, "energy", `T${pointOf(at).period}`),
    numbers: () => ({
      heads: ["time_s", ...ENERGIES.map(([of]) => `${of}_kJ`), "input_energy_kJ"],
      rows: Array.from(found.arrays.time, (t, i) => [t, ...ENERGIES.map(([of]) => found.arrays[of][i]), found.arrays.input_energy[i]]),
    }),
  };
}

function allPicture(everything) {
  const index = chosenIndex();
  return {
    id: "all-records", place: "curves", look: "curve",
    plot: () => allPlot(state, index, everything),
    title: () => `${index.title} over pretension: all ${everything.length} records, from ${everything[0].name}, period ${written(AXES.period[state.period], "s")}, stiffness ratio ${written(AXES.stiffness_ratio[state.ratio])}`,
    words: () => [element("div", allWords(state, index, everything))],
    origin: () => `Records: ${everything.map(({ name }) => name).join(", ")}`,
    file: () => fileName("all", index.name, "over-pretension"),
    numbers: () => ({
      heads: [`pretension_${FORCE}`, ...everything.map(({ name }) => `${name}_${named(index)}`)],
      rows: AXES.pretension.map((force, f) => [force, ...everything.map(({ numbers }) => cell(numbers[index.name], state.ratio, f, state.period))]),
    }),
    click: (point) => movePoint(AXES.period[state.period], point.x),
  };
}

// More are too many to tell apart, and to load.
const MANY = 60;
async function showAll(turn) {
  const { cube } = about.records[state.record], ks = [...about.records.keys()].filter((k) => about.records[k].cube === cube);
  if (ks.length < 2 || ks.length > MANY) { discard("all-records"); return; }
  const everything = await Promise.all(ks.map(async (k) => ({ k, name: about.records[k].name, numbers: await recordNumbers(k) })));
  if (turn === asked) await draw(allPicture(everything));
}

// ---- drawing: the map answers at once, all else once it is on the screen. Marks tell who measures.

async function show(delay = 0) {
  const turn = ++asked;
  byId("pictures").setAttribute("aria-busy", "true");
  controlsFromState();
  try {
    const shown = await shownRecords();
    if (turn !== asked) return;
    if (state.force === null) state.force = gridBest(state, chosenIndex(), shown[0].numbers, state.period) ?? 0;
    controlsFromState();
    toAddress();
    const index = chosenIndex();
    const scale = scaleOf(shown.map(({ numbers }) => numbers[index.name]), index.colours, index.neutral);
    if (shown.length === 1) ["map-1", "surface-1", "history-1", "energy-1"].forEach(discard);
    const maps = (kind) => shown.map(({ k, numbers }, n) => () => draw(mapPicture(n, k, numbers, scale, kind)));
    const curves = ["over-pretension", ...(index.best ? ["best-pretension"] : [])].map((kind) => () => draw(curvePicture(kind, shown)));
    if (!index.best) discard("best-pretension");
    for (const step of maps("map")) await step();
    performance.mark("map");
    await painted();
    if (turn !== asked) return;
    // At first the surface has to wait for what takes less time to set up.
    const first = !cards.has("surface-0");
    const coming = about.served ? new Promise((done) => setTimeout(() => done(turn === asked && runHistories(shown)), delay)) : null;
    if (first) for (const step of curves) await step();
    if (first) await Promise.race([coming, new Promise((done) => setTimeout(done, 1500))]);
    performance.mark("ready");
    for (const step of maps("surface")) {
      if (turn !== asked) return;
      await step();
    }
    performance.mark("surface");
    if (!first) for (const step of curves) await step();
    orderCards();
    tables(shown);
    await showAll(turn);
    await coming;
    orderCards();
    // A record that has no history has no search either, and that was said.
    if (!about.served || byId("status").textContent || turn !== asked) return;
    await searchHere(shown);
    if (turn === asked) await draw(curvePicture("over-pretension", shown));
  } catch (error) {
    complain(error);
  } finally {
    if (turn === asked) byId("pictures").setAttribute("aria-busy", "false");
  }
}

// The second record's map stands under the first one's, each beside its surface; histories likewise, whichever came first.
const ORDER = {
  maps: ["map-0", "surface-0", "map-1", "surface-1"], histories: ["history-0", "history-1"],
  curves: ["over-pretension", "best-pretension", "all-records", "energy-0", "energy-1"],
};
function orderCards() {
  for (const [place, ids] of Object.entries(ORDER)) {
    const wanted = ids.filter((id) => cards.has(id)).map((id) => cards.get(id).figure);
    if (wanted.some((figure, n) => byId(place).children[n] !== figure)) byId(place).append(...wanted);
  }
}

const COMPILING = "The history is on its way. After an installation kernels are compiled once, which takes a minute or two.";

async function runHistories(shown) {
  byId("status").textContent = "";
  for (const n of shown.keys()) cards.get(`history-${n}`)?.plotted.classList.add("wait");
  const problems = [];
  const patience = setTimeout(() => { byId("status").textContent = COMPILING; }, 4000);
  await Promise.all(shown.map(async ({ k }, n) => {
    try {
      const found = await askHistory(state, k, n);
      if (found === null) return;
      histories.set(n, found);
      await draw(historyPicture(n, k, found));
      await draw(energyPicture(n, k, found));
      cards.get(`history-${n}`).plotted.classList.remove("wait");
      tables(shown);
    } catch (error) {
      histories.delete(n);
      discard(`history-${n}`);
      discard(`energy-${n}`);
      problems.push(error.message);
    }
  }));
  clearTimeout(patience);
  if (problems.length || byId("status").textContent === COMPILING) byId("status").textContent = [...new Set(problems)].join(" ");
}

// ---- words below the pictures

function tables(shown) {
  const open = new Set(Array.from(byId("more").querySelectorAll("details[open]"), (d) => d.id));
  const index = chosenIndex(), blocks = [];
  const block = (id, summary, ...content) => {
    const made = element("details");
    made.id = id;
    made.open = open.has(id);
    made.append(element("summary", summary), ...content);
    blocks.push(made);
  };
  const rows = about.indices.map((one) => [one.title, ...shown.map(({ numbers }) => written(cell(numbers[one.name], state.ratio, state.force, state.period), one.unit))]);
  block("cell", "All indices of the point", table(`The cube at ${pointWords(state)}`, ["Index", ...shown.map(({ k }) => about.records[k].name)], rows));
  if (about.served) {
    shown.forEach(({ k }, n) => {
      const found = histories.get(n);
      if (!found || found.record !== about.records[k].record) return;
      const compared = found.compared.map((one) => [one.title, written(one.history, one.unit), one.cube === null ? "not in the cube" : written(one.cube, one.unit)]);
      block(`compared-${n}`, `History and cube: ${about.records[k].name}`, table(`Peaks at ${pointWords(state)}`, ["Quantity", "History", "Cube"], compared));
    });
  }
  if (index.best) {
    const { heads, rows: numbers } = bestNumbers(state, index, shown);
    block("best-table", "Best pretension at each period, as a table",
      table(`${index.title}, stiffness ratio ${written(AXES.stiffness_ratio[state.ratio])}`, heads.map((head) => head.replace(/_/g, " ")), numbers.map((row) => row.map((v) => written(v)))));
  }
  const list = element("dl");
  for (const { k } of shown) list.append(element("dt", about.records[k].name), element("dd", originWords(k)));
  for (const cube of about.cubes) {
    for (const [term, text] of [["Cube", [cube.name, cube.title].filter(Boolean).join(": ")], ["Made", cube.made], ["Note", cube.comment]]) {
      if (text) list.append(element("dt", term), element("dd", text));
    }
  }
  block("origin-of-numbers", "Where the numbers come from", list);
  byId("more").replaceChildren(...blocks);
}

// ---- controls

function controlsFromState() {
  const told = {
    ratio: written(AXES.stiffness_ratio[state.ratio]),
    period: written(AXES.period[state.period], "s"),
    force: state.force === null ? "" : written(AXES.pretension[state.force], FORCE),
  };
  const at = pointOf(state);
  for (const field of FIELDS) {
    const box = byId(`field-${field.name}`);
    if (box && document.activeElement !== box) box.value = Number.isFinite(at[field.name]) ? String(Number(at[field.name].toPrecision(6))) : "";
  }
  unitsFromState();
  const force = FIELDS.find((field) => field.name === "pretension"), named = byId("label-pretension");
  if (named) named.textContent = `Pretension, ${force.unit}`;
  for (const name of ["record", "compare", "index", "ratio", "period", "force"]) {
    const value = String(state[name] ?? 0);
    if (control[name].value !== value) control[name].value = value;
    if (name in told) {
      byId(`${name}-value`).textContent = told[name];
      control[name].setAttribute("aria-valuetext", told[name]);
    }
  }
  control.best.disabled = !chosenIndex().best;
  control.line.disabled = !chosenIndex().searched || searching;
  for (const option of control.compare.options) option.disabled = Number(option.value) === state.record;
}

// The best pretension at the point's period, between the cube's; it takes a twentieth of a second.
async function searchHere(shown) {
  if (!chosenIndex().searched) return;
  const asking = { ...state };
  await Promise.all(shown.map(({ k }) => search(asking, k, asking.period)));
}

// The same at every period; it takes a second or more, so it has a button.
let searching = false;
async function searchLine() {
  searching = true;
  controlsFromState();
  control.line.textContent = "Searching\u2026";
  try {
    for (const { k } of await shownRecords()) await search(state, k);
  } catch (error) {
    complain(error);
  } finally {
    searching = false;
    control.line.textContent = "Search the best line";
    show();
  }
}

async function chooseBest() {
  chosen = true;
  state.free = null;
  const told = searchedAt(state, state.record, state.period);
  if (told && Number.isFinite(told.value)) {
    state.force = nearest(AXES.pretension, told.pretension);
    state.free = freeAt({ ...pointOf(state), pretension: told.pretension }, state.record);
    show();
    return;
  }
  const place = gridBest(state, chosenIndex(), await recordNumbers(state.record), state.period);
  if (place !== null) state.force = place;
  show();
}

function connect() {
  byId("name").textContent = about.name;
  const several = about.cubes.length > 1;
  byId("frame").replaceChildren(...about.cubes.map(({ name, frame }) => element("span", (several ? `${name}: ` : "") +
    frame.map((one) => `${one.title} ${written(one.value, one.unit)}`).join(", "))));
  byId("origin").textContent = `${about.records.length} records, ${SIZES.ratio} stiffness ratios, ${SIZES.force} pretensions, ${SIZES.period} periods. ${about.cubes[0].title}.`;
  options(control.record, about.records.map((r) => r.name));
  options(control.compare, ["no other", ...about.records.map((r) => r.name)], -1);
  options(control.index, about.indices.map((index) => index.title));
  for (const name of ["ratio", "period", "force"]) {
    control[name].max = String(SIZES[name] - 1);
    control[name].disabled = SIZES[name] === 1;
  }
  const follow = (name, event, delay) => control[name].addEventListener(event, () => {
    state[name] = Number(control[name].value);
    if (name !== "record" && name !== "compare" && name !== "index") state.free = null;
    else chosen = true;
    // The other cube's picture stays that of the same earthquake.
    if (name === "record" && about.cubes.length > 1 && state.compare >= 0) state.compare = counterpart(state.record);
    if (state.compare === state.record) state.compare = -1;
    show(delay);
  });
  for (const name of ["record", "compare", "index"]) follow(name, "change", 0);
  // A slider being dragged asks for the history when it rests.
  for (const name of ["ratio", "period", "force"]) follow(name, "input", 120);
  if (about.served) fields();
  byId("strong").addEventListener("change", () => { state.strong = byId("strong").checked; redraw("history"); });
  byId("strong").parentElement.hidden = !about.served;
  control.best.addEventListener("click", chooseBest);
  control.line.addEventListener("click", searchLine);
  control.line.hidden = !about.served;
  connectPage();
  if (!about.served) {
    byId("histories").append(notice(`This file has no server behind it, so a click shows the peaks of its cell in the tables below. For histories: fdspec explore ${about.name}`));
  }
}

// Numbers of any point, not the cube's alone: histories are computed there.
function fields() {
  const place = byId("fields");
  for (const field of FIELDS) {
    const row = element("div"), label = element("label", field.title[0].toUpperCase() + field.title.slice(1) + (field.unit ? `, ${field.unit}` : "")), box = element("input");
    box.id = `field-${field.name}`;
    box.inputMode = "decimal";
    box.autocomplete = "off";
    label.htmlFor = box.id;
    label.id = `label-${field.name}`;
    box.addEventListener("change", () => typed(field, box));
    row.append(label, box);
    place.append(row);
  }
  byId("anywhere").hidden = false;
}

function typed(field, box) {
  const value = numberOf(box.value.replace(",", "."));
  if (value === null) { complain(new Error(`${field.title} must be a number, not ${box.value || "nothing"}.`)); return; }
  byId("status").textContent = "";
  chosen = true;
  const at = { ...pointOf(state), [field.name]: value };
  state.period = nearest(AXES.period, at.period);
  state.ratio = nearest(AXES.stiffness_ratio, at.stiffness_ratio);
  state.force = nearest(AXES.pretension, at.pretension);
  const cubes = pointOf({ ...state, free: null });
  state.free = FIELDS.every((one) => Math.abs(at[one.name] - cubes[one.name]) <= 1e-9 * Math.abs(cubes[one.name])) ? null : freeAt(at, state.record);
  show();
}

start();
