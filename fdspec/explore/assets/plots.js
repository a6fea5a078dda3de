// Pictures of the cube: each function returns what Plotly draws, and draws nothing itself.

// Perceptually even, and safe for colour-blind eyes and in grey print.
const EVEN = "Viridis";
// Two colours that part at a neutral value: blue where a damper helps, red where it harms (ColorBrewer's RdBu).
const HARM_TO_HELP = ["#67001f", "#b2182b", "#d6604d", "#f4a582", "#fddbc7", "#f7f7f7", "#d1e5f0", "#92c5de", "#4393c3", "#2166ac", "#053061"];
function coloursOf(index) {
  if (index.neutral === null) return EVEN;
  const colours = index.best === "least" ? [...HARM_TO_HELP].reverse() : HARM_TO_HELP;
  return colours.map((colour, k) => [k / (colours.length - 1), colour]);
}

function ends(values) {
  return [values[0], values[values.length - 1]];
}

function pointMark(s, index, numbers) {
  const z = cell(numbers[index.name], s.ratio, s.force, s.period), at = pointOf(s);
  return { x: [at.period], y: [at.pretension], z: [Number.isFinite(z) ? z : null] };
}

function contourPlot(s, index, numbers, scale, best) {
  const point = pointMark(s, index, numbers);
  const data = [
    {
      type: "contour", x: AXES.period, y: AXES.pretension, z: slice(numbers[index.name], s.ratio),
      colorscale: coloursOf(index), zmin: scale.low, zmax: scale.high, autocontour: false,
      contours: { start: scale.low, end: scale.high, size: scale.step },
      line: { color: index.neutral === null ? "rgba(255,255,255,0.6)" : "rgba(0,0,0,0.18)", width: 0.5 }, connectgaps: false,
      colorbar: { title: { text: index.unit, side: "top" }, thickness: 12, len: 1, outlinewidth: 0, x: 1.01, xpad: 2, ...NUMBERS, ...scaleTicks(scale) },
      hovertemplate: `%{x} s, %{y} ${FORCE}<br>%{z:.4g} ${index.unit}<extra></extra>`,
    },
    {
      type: "scatter", mode: "lines+markers", x: best.x, y: best.y, hoverinfo: "skip", cliponaxis: false,
      line: { color: "#fff", width: 1.5 }, marker: { color: "#fff", size: 5, line: { color: "#000", width: 1 } },
    },
    {
      type: "scatter", mode: "markers", x: point.x, y: point.y, hoverinfo: "skip", cliponaxis: false,
      marker: { symbol: "x-open", color: "#000", size: 13, line: { width: 5 } },
    },
    {
      type: "scatter", mode: "markers", x: point.x, y: point.y, hoverinfo: "skip", cliponaxis: false,
      marker: { symbol: "x-open", color: "#fff", size: 11, line: { width: 2 } },
    },
  ];
  // White is the middle of two colours: there the line of the best has a dark edge.
  if (index.neutral !== null) data.splice(1, 0, neutralLine(index, data[0]), { ...data[1], mode: "lines", line: { color: "#1b2733", width: 3.5 } });
  return { data, layout: layout({ xaxis: axis("period without brace, s", { range: ends(AXES.period), nticks: TICKS }), yaxis: axis(`pretension, ${FORCE}`, { range: ends(AXES.pretension), nticks: TICKS }) }) };
}

// Where a damper begins to harm.
function neutralLine(index, { x, y, z }) {
  return {
    type: "contour", x, y, z, autocontour: false, contours: { start: index.neutral, end: index.neutral, size: 1, coloring: "none" },
    line: { color: "#000", width: 2 }, showscale: false, hoverinfo: "skip", connectgaps: false, name: "neutral",
  };
}

// Numbers beside the colours; the neutral value among them stands out.
function scaleTicks({ low, high, step, neutral }) {
  if (neutral === undefined) return { tick0: low, dtick: 4 * step };
  const steps = Math.round((high - neutral) / step), every = Math.max(1, Math.ceil(steps / 3));
  const values = [];
  for (let k = -Math.floor(steps / every) * every; k <= steps; k += every) values.push(neutral + k * step);
  return { tickvals: values, ticktext: values.map((v) => (v === neutral ? `<b>${written(v)}</b>` : written(v))), ticks: "outside", ticklen: 4 };
}

function eye(turn) {
  const angle = (turn * Math.PI) / 180;
  return { x: 1.85 * Math.cos(angle), y: 1.85 * Math.sin(angle), z: 1.0 };
}

function surfacePlot(s, index, numbers, scale, best) {
  const point = pointMark(s, index, numbers);
  const lift = (z) => (z === null ? null : z + 0.01 * (scale.high - scale.low));
  const data = [
    {
      type: "surface", x: AXES.period, y: AXES.pretension, z: slice(numbers[index.name], s.ratio),
      colorscale: coloursOf(index), cmin: scale.low, cmax: scale.high, showscale: false, lighting: { ambient: 0.85, diffuse: 0.4, specular: 0.05 },
      hovertemplate: `%{x} s, %{y} ${FORCE}<br>%{z:.4g} ${index.unit}<extra></extra>`,
    },
    {
      type: "scatter3d", mode: "lines+markers", x: best.x, y: best.y, z: best.z.map(lift), hoverinfo: "skip",
      line: { color: "#fff", width: 5 }, marker: { color: "#fff", size: 2.5, line: { color: "#000", width: 1 } },
    },
    {
      type: "scatter3d", mode: "markers", x: point.x, y: point.y, z: point.z.map(lift), hoverinfo: "skip",
      marker: { symbol: "x", color: "#D55E00", size: 5 },
    },
  ];
  const side = (title, more) => ({ title: { text: title, font: { ...FONT, size: 11 } }, tickfont: { ...FONT, size: 10 }, ...NUMBERS, gridcolor: LOOK.spaceGrid, showspikes: false, backgroundcolor: LOOK.space, showbackground: true, ...more });
  return {
    data,
    layout: layout({
      margin: { l: 0, r: 0, t: 0, b: 0 },
      scene: {
        uirevision: "kept", dragmode: TOUCH ? false : "turntable", aspectmode: "manual", aspectratio: { x: 1.25, y: 1, z: 0.7 },
        camera: { eye: eye(s.turn), center: { x: 0, y: 0, z: -0.2 } },
        xaxis: side("period, s", { range: ends(AXES.period), nticks: TICKS }), yaxis: side(`pretension, ${FORCE}`, { range: ends(AXES.pretension), nticks: TICKS }), zaxis: side(index.unit || "", { range: [scale.low, scale.high] }),
      },
    }),
  };
}

// The index over pretension at the chosen period; rings stand within 5 % of the least. Where the best between the
// cube's pretensions was searched, a star is at it and a band about it.
function slicePlot(s, index, shown) {
  const data = [], bands = [];
  shown.forEach(({ k, numbers }, n) => {
    const look = RECORD_LINES[n];
    const y = AXES.pretension.map((_, f) => cell(numbers[index.name], s.ratio, f, s.period));
    const least = Math.min(...y.filter(Number.isFinite));
    const close = index.best === "least" ? y.map((v) => v <= 1.05 * least) : y.map(() => false);
    data.push({
      type: "scatter", mode: "lines+markers", name: plain(about.records[k].name), x: AXES.pretension, y,
      line: { color: look.color, dash: look.dash, width: 2 },
      marker: { symbol: close.map((c) => (c ? `${look.symbol}-open` : look.symbol)), color: look.color, size: close.map((c) => (c ? 11 : 6)), line: { width: 2 } },
      hovertemplate: `%{x} ${FORCE}: %{y:.4g} ${index.unit}<extra>%{fullData.name}</extra>`,
    });
    const told = searchedAt(s, k, s.period);
    if (told && Number.isFinite(told.value)) {
      data.push({
        type: "scatter", mode: "markers", name: `${plain(about.records[k].name)}, searched`, x: [told.pretension], y: [told.value], showlegend: false,
        marker: { symbol: "star", color: look.color, size: 15, line: { color: "#fff", width: 1 } },
        hovertemplate: `best: %{x:.4g} ${FORCE}: %{y:.4g} ${index.unit}<extra>%{fullData.name}</extra>`,
      });
      bands.push({ type: "rect", x0: told.start, x1: Math.min(told.end, 1.05 * AXES.pretension[SIZES.force - 1]), y0: 0, y1: 1, yref: "paper", fillcolor: look.color, opacity: 0.13, line: { width: 0 }, layer: "below" });
    }
    if (index.name !== "acceleration") return;
    const level = (name, at, dash) => numbers[name] && data.push({
      type: "scatter", mode: "lines", name: `${plain(about.records[k].name)}, ${name} frame`, x: [AXES.pretension[0], AXES.pretension[SIZES.force - 1]],
      y: [numbers[name][at], numbers[name][at]], line: { color: look.color, dash, width: 1.2 }, hoverinfo: "skip", showlegend: false,
    });
    level("bare", s.period, "dot");
    level("braced", s.ratio * SIZES.period + s.period, "longdashdot");
  });
  return {
    data,
    layout: layout({
      showlegend: true, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 }, margin: { l: 58, r: 12, t: 30, b: 42 },
      xaxis: axis(`pretension, ${FORCE}`), yaxis: axis(folded(`${index.title}${unitOf(index)}`), { rangemode: "tozero", automargin: true }),
      shapes: [...bands, ...neutralLevel(index), { type: "line", x0: pointOf(s).pretension, x1: pointOf(s).pretension, y0: 0, y1: 1, yref: "paper", line: { color: LIMIT, width: 1, dash: "dot" } }],
    }),
  };
}

// The line across a chart where the damper neither helps nor harms.
function neutralLevel(index) {
  return index.neutral === null ? [] : [{ type: "line", xref: "x domain", x0: 0, x1: 1, y0: index.neutral, y1: index.neutral, layer: "below", line: { color: LIMIT, width: 1.2 } }];
}

// The best pretension at every period, and what it gives.
function bestPlot(s, index, shown) {
  const data = [];
  shown.forEach(({ k, numbers }, n) => {
    const look = RECORD_LINES[n], best = bestLine(s, index, numbers, k);
    const name = plain(about.records[k].name);
    const drawn = { type: "scatter", mode: "lines+markers", x: best.x, line: { color: look.color, dash: look.dash, width: 1.5 }, marker: { symbol: look.symbol, color: look.color, size: 4 } };
    data.push({ ...drawn, name, y: best.y, hovertemplate: `%{x} s: %{y} ${FORCE}<extra>${name}</extra>` });
    data.push({ ...drawn, name, y: best.z, yaxis: "y2", showlegend: false, hovertemplate: `%{x} s: %{y:.4g} ${index.unit}<extra>${name}</extra>` });
  });
  return {
    data,
    layout: layout({
      showlegend: true, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 }, margin: { l: 58, r: 12, t: 30, b: 42 },
      xaxis: axis("period without brace, s", { anchor: "y2" }),
      yaxis: axis(`best pretension, ${FORCE}`, { domain: [0.54, 1], rangemode: "tozero" }),
      yaxis2: axis(`its index${unitOf(index)}`, { domain: [0, 0.46], rangemode: "tozero" }),
      shapes: [{ type: "line", x0: pointOf(s).period, x1: pointOf(s).period, y0: 0, y1: 1, yref: "paper", line: { color: LIMIT, width: 1, dash: "dot" } }],
    }),
  };
}

function historyPlot(history, narrow, span) {
  const { time, displacement, brace_displacement, bare_displacement, friction_force, acceleration, ground_acceleration, loop_slip, loop_force } = history.arrays;
  const line = (name, unit, x, y, color, more) => ({
    type: "scatter", mode: "lines", name, x, y, line: { color, width: 1.2 },
    hovertemplate: `%{x:.4g} s, %{y:.4g} ${unit}<extra>${name}</extra>`, ...more,
  });
  const data = [
    line("floor", LENGTH, time, displacement, FLOOR),
    line("brace", LENGTH, time, brace_displacement, BRACE, { line: { color: BRACE, width: 1, dash: "dot" } }),
    line("friction", FORCE, time, friction_force, FLOOR, { yaxis: "y2", showlegend: false }),
    line("floor, absolute", ACCELERATION, time, acceleration, FLOOR, { yaxis: "y3", showlegend: false }),
    line("ground", ACCELERATION, time, ground_acceleration, GROUND, { yaxis: "y3", line: { color: GROUND, width: 0.8 } }),
    line("loop", FORCE, loop_slip, loop_force, FLOOR, { xaxis: "x2", yaxis: "y4", showlegend: false, hovertemplate: `%{x:.4g} ${LENGTH}, %{y:.4g} ${FORCE}<extra>loop</extra>` }),
    line("bare frame", LENGTH, time.subarray(0, bare_displacement.length), bare_displacement, LOOK.grey, { line: { color: LOOK.grey, width: 1 }, visible: "legendonly" }),
  ];
  const rows = narrow ? [[0.83, 1], [0.615, 0.785], [0.4, 0.57]] : [[0.7, 1], [0.36, 0.64], [0, 0.3]];
  const force = history.slip_force;
  const limits = force === null ? [] : [force, -force].flatMap((y) => [["x domain", "y2"], ["x2 domain", "y4"]].map(([xref, yref]) => (
    { type: "line", xref, yref, x0: 0, x1: 1, y0: y, y1: y, line: { color: LIMIT, width: 1, dash: "dash" } })));
  return {
    data,
    layout: layout({
      showlegend: true, legend: { orientation: "h", y: 1.01, yanchor: "bottom", x: 0 }, margin: { l: 58, r: 12, t: 26, b: 40 },
      xaxis: axis("time, s", { domain: narrow ? [0, 1] : [0, 0.62], anchor: "y3", ...(span ? { range: span } : {}) }),
      yaxis: axis(`displacement,<br>${LENGTH}`, { domain: rows[0] }), yaxis2: axis(`friction,<br>${FORCE}`, { domain: rows[1] }), yaxis3: axis(`acceleration,<br>${ACCELERATION}`, { domain: rows[2] }),
      xaxis2: axis(`slip, floor less brace, ${LENGTH}`, { domain: narrow ? [0, 1] : [0.71, 1], anchor: "y4" }),
      yaxis4: axis(`friction, ${FORCE}`, { domain: narrow ? [0, 0.3] : [0, 1], anchor: "x2" }),
      shapes: limits, uirevision: span ? `kept ${span}` : "kept",
    }),
  };
}

// From when 5 % of the ground's squared acceleration has come to when 95 % has: the strong motion.
function strongMotion({ time, ground_acceleration }) {
  let total = 0;
  const sums = Array.from(ground_acceleration, (a) => (total += a * a));
  const at = (share) => time[Math.max(0, sums.findIndex((sum) => sum >= share * total))];
  return total > 0 ? [at(0.05), at(0.95)] : null;
}

const ENERGIES = [
  ["friction_energy", "friction", "#0072B2"], ["viscous_energy", "viscous damping", "#56B4E9"],
  ["strain_energy", "strain", "#E69F00"], ["kinetic_energy", "motion", "#D55E00"],
];

// Where the energy goes: the terms stacked, and the input, which lies on their top.
function energyPlot(history) {
  const { time } = history.arrays;
  const data = ENERGIES.map(([name, title, color]) => ({
    type: "scatter", mode: "lines", name: title, x: time, y: history.arrays[name], stackgroup: "energy", line: { width: 0, color }, fillcolor: color,
    hovertemplate: `%{x:.4g} s: %{y:.4g} kJ<extra>${title}</extra>`,
  }));
  data.push({ type: "scatter", mode: "lines", name: "input", x: time, y: history.arrays.input_energy, line: { color: LOOK.ink, width: 1.4 }, hovertemplate: "%{x:.4g} s: %{y:.4g} kJ<extra>input</extra>" });
  return {
    data,
    layout: layout({
      showlegend: true, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 }, margin: { l: 58, r: 12, t: 30, b: 42 },
      xaxis: axis("time, s"), yaxis: axis("energy, kJ", { rangemode: "tozero" }),
    }),
  };
}

// The index over pretension under every record, grey, and what they say together.
function allPlot(s, index, everything) {
  const over = everything.map(({ numbers }) => AXES.pretension.map((_, f) => cell(numbers[index.name], s.ratio, f, s.period)));
  const column = (f) => over.map((line) => line[f]);
  const said = (of) => AXES.pretension.map((_, f) => (column(f).every(Number.isFinite) ? of(column(f)) : null));
  const hover = (name) => `%{x} ${FORCE}: %{y:.4g} ${index.unit}<extra>${name}</extra>`;
  const data = over.map((y, n) => ({
    type: "scatter", mode: "lines", name: plain(about.records[everything[n].k].name), x: AXES.pretension, y, line: { color: LOOK.grey, width: 1 }, showlegend: false,
    hovertemplate: hover(plain(about.records[everything[n].k].name)),
  }));
  const bad = index.best === "most" ? [0.16, Math.min] : [0.84, Math.max];
  for (const [name, of, color, dash] of [
    ["median", (v) => quantile(v, 0.5), LOOK.median, "solid"],
    [index.best === "most" ? "16 %" : "84 %", (v) => quantile(v, bad[0]), LOOK.high, "dash"],
    ["worst", (v) => bad[1](...v), LOOK.worst, "dot"],
  ]) data.push({ type: "scatter", mode: "lines", name, x: AXES.pretension, y: said(of), line: { color, dash, width: 2.4 }, hovertemplate: hover(name) });
  return {
    data,
    layout: layout({
      showlegend: true, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 }, margin: { l: 58, r: 12, t: 30, b: 42 },
      xaxis: axis(`pretension, ${FORCE}`), yaxis: axis(folded(`${index.title}${unitOf(index)}`), { rangemode: "tozero", automargin: true }),
      shapes: [...neutralLevel(index), { type: "line", x0: pointOf(s).pretension, x1: pointOf(s).pretension, y0: 0, y1: 1, yref: "paper", line: { color: LIMIT, width: 1, dash: "dot" } }],
    }),
  };
}
