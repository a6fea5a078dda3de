// The page: controls, cards of pictures, and what follows from what.

const byId = (id) => document.getElementById(id);
const control = Object.fromEntries(["record", "compare", "index", "ratio", "period", "force", "turn", "best", "line"].map((id) => [id, byId(id)]));

const state = fromAddress({
  record: 0, compare: -1, index: 0, turn: -55,
  ratio: nearest(AXES.stiffness_ratio, 4), period: nearest(AXES.period, 0.5), force: null,
});
const cards = new Map();
const histories = new Map();

// ---- state in the address, so that a view can be kept and sent

function fromAddress(usual) {
  const told = new URLSearchParams(location.hash.slice(1));
  const last = { record: about.records.length, compare: about.records.length, index: about.indices.length, ratio: SIZES.ratio, period: SIZES.period, force: SIZES.force };
  for (const [name, count] of Object.entries(last)) {
    const value = Number(told.get(name) ?? NaN);
    if (Number.isInteger(value) && value >= 0 && value < count) usual[name] = value;
  }
  if (usual.compare === usual.record) usual.compare = -1;
  return usual;
}

function toAddress() {
  const told = Object.entries(state).filter(([name, value]) => name !== "turn" && value >= 0);
  history.replaceState(null, "", "#" + new URLSearchParams(told));
}

// ---- cards

// A card holds one picture with its heading, its words and its downloads.
// picture: id, place, look, plot(), title(), words(), origin(), file(), numbers(), links().
function card(picture) {
  if (cards.has(picture.id)) {
    Object.assign(cards.get(picture.id), picture);
    return cards.get(picture.id);
  }
  const figure = element("figure"), head = element("div"), save = element("div"), plot = element("div");
  const title = element("h2"), words = element("figcaption");
  figure.id = picture.id;
  title.id = `${picture.id}-title`;
  words.id = `${picture.id}-words`;
  // What a moved point leads to is spoken too.
  if (picture.look === "history") words.setAttribute("aria-live", "polite");
  figure.setAttribute("aria-labelledby", title.id);
  head.className = "head";
  save.className = "save";
  plot.className = `plot ${picture.look}`;
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-describedby", words.id);
  const made = Object.assign(picture, { figure, plotted: plot, titled: title, worded: words, saves: save, drawn: null });
  const button = (text, label, action) => {
    const b = element("button", text);
    b.type = "button";
    b.dataset.label = label;
    b.addEventListener("click", () => Promise.resolve(action()).catch(complain));
    save.append(b);
  };
  button("PNG", "Download as PNG", () => savePicture(made, "png"));
  button("SVG", "Download as SVG", () => savePicture(made, "svg"));
  button("CSV", "Download the numbers as CSV", () => saveNumbers(made));
  if (picture.netcdf && about.served) button("netCDF", "Download as netCDF", () => picture.netcdf());
  head.append(title, save);
  figure.append(head, plot, words);
  byId(picture.place).append(figure);
  cards.set(picture.id, made);
  return made;
}

async function draw(picture) {
  const made = card(picture);
  made.titled.textContent = made.title();
  made.plotted.setAttribute("aria-label", made.title());
  made.worded.replaceChildren(...made.words());
  for (const b of made.saves.children) b.setAttribute("aria-label", `${b.dataset.label}: ${made.title()}`);
  const { data, layout: drawn } = made.plot();
  const first = made.drawn === null;
  made.drawn = true;
  await Plotly.react(made.plotted, data, drawn, CONFIG);
  if (first && made.click) made.plotted.on("plotly_click", (event) => made.click(event.points[0]));
}

function discard(id) {
  const made = cards.get(id);
  if (!made) return;
  Plotly.purge(made.plotted);
  made.figure.remove();
  cards.delete(id);
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
  };
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
    plot: () => historyPlot(found, byId("histories").clientWidth < 700),
    title: () => `History: ${name}, ${pointWords(at)}`,
    words: () => [element("div", historyWords(found)), ...(found.notice ? [notice(found.notice)] : [])],
    origin: () => originWords(k),
    file: () => fileName(name, "history", `T${AXES.period[at.period]}`, `SR${AXES.stiffness_ratio[at.ratio]}`, `${AXES.pretension[at.force]}kN`),
    numbers: () => historyNumbers(found),
    netcdf: async () => {
      const now = cards.get(`history-${n}`);
      download(`${now.file()}.nc`, await ask(historyAddress(now.at, now.k, "history.nc")), "application/x-netcdf");
    },
    at, k,
  };
}

function notice(text) {
  const made = element("p", text);
  made.className = "notice";
  return made;
}

function complain(error) {
  byId("status").textContent = error.message;
}

// ---- drawing: the map answers at once, all else once it is on the screen. Marks tell who measures.

let asked = 0;
// The next frame is painted when this is done; a frame's own callback would still hold it up.
const painted = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));

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
    const scale = scaleOf(shown.map(({ numbers }) => numbers[index.name]), index.colours);
    if (shown.length === 1) ["map-1", "surface-1", "history-1"].forEach(discard);
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
const ORDER = { maps: ["map-0", "surface-0", "map-1", "surface-1"], histories: ["history-0", "history-1"] };
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
      cards.get(`history-${n}`).plotted.classList.remove("wait");
      tables(shown);
    } catch (error) {
      histories.delete(n);
      discard(`history-${n}`);
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
      if (!found || found.record !== about.records[k].name) return;
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
  for (const [term, text] of [["Cube", about.title], ["Made", about.made], ["Note", about.comment]]) {
    if (text) list.append(element("dt", term), element("dd", text));
  }
  block("origin-of-numbers", "Where the numbers come from", list);
  byId("more").replaceChildren(...blocks);
}

// ---- controls

function options(select, names, first = 0) {
  names.forEach((name, k) => {
    const made = element("option", name);
    made.value = String(k + first);
    select.append(made);
  });
}

function controlsFromState() {
  const told = {
    ratio: written(AXES.stiffness_ratio[state.ratio]),
    period: written(AXES.period[state.period], "s"),
    force: state.force === null ? "" : written(AXES.pretension[state.force], "kN"),
    turn: `${state.turn}\u00a0°`,
  };
  for (const name of ["record", "compare", "index", "ratio", "period", "force", "turn"]) {
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
  const place = gridBest(state, chosenIndex(), await recordNumbers(state.record), state.period);
  if (place !== null) state.force = place;
  show();
}

function connect() {
  byId("name").textContent = about.name;
  byId("origin").textContent = `${about.records.length} records, ${SIZES.ratio} stiffness ratios, ${SIZES.force} pretensions, ${SIZES.period} periods. ${about.title}.`;
  options(control.record, about.records.map((r) => r.name));
  options(control.compare, ["no other", ...about.records.map((r) => r.name)], -1);
  options(control.index, about.indices.map((index) => index.title));
  for (const name of ["ratio", "period", "force"]) {
    control[name].max = String(SIZES[name] - 1);
    control[name].disabled = SIZES[name] === 1;
  }
  const follow = (name, event, delay) => control[name].addEventListener(event, () => {
    state[name] = Number(control[name].value);
    if (state.compare === state.record) state.compare = -1;
    show(delay);
  });
  for (const name of ["record", "compare", "index"]) follow(name, "change", 0);
  // A slider being dragged asks for the history when it rests.
  for (const name of ["ratio", "period", "force"]) follow(name, "input", 120);
  control.turn.addEventListener("input", async () => {
    state.turn = Number(control.turn.value);
    controlsFromState();
    await painted();
    for (const [id, made] of cards) if (id.startsWith("surface")) Plotly.relayout(made.plotted, { "scene.camera.eye": eye(state.turn) });
  });
  control.best.addEventListener("click", chooseBest);
  control.line.addEventListener("click", searchLine);
  control.line.hidden = !about.served;
  byId("controls").addEventListener("submit", (event) => event.preventDefault());
  if (!about.served) {
    byId("histories").append(notice(`This file has no server behind it, so a click shows the peaks of its cell in the tables below. For histories: fdspec explore ${about.name}`));
  }
}

connect();
show();
