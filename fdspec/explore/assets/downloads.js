// Downloads: a picture with its title, and the numbers behind it.

const PICTURE = { width: 1100, height: 700 };
// Letters of a line of the title, at its size.
const LETTERS = 125;

function download(name, content, type) {
  const link = element("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function fileName(...parts) {
  return parts.join("-").replace(/[^\p{L}\p{N}._-]+/gu, "_");
}

// A figure made anew at one size, so that the file does not depend on the window.
async function savePicture(picture, format) {
  const { data, layout: drawn } = picture.plot();
  const lines = [picture.title(), picture.origin()].filter(Boolean).flatMap((text) => folded(text, LETTERS).split("<br>")).map(plain);
  const legend = drawn.showlegend ? 26 : 0;
  const figure = {
    data,
    layout: {
      ...drawn, ...PICTURE, title: { text: lines.join("<br>"), font: { ...FONT, size: 14 }, x: 0.02, xanchor: "left", y: 0.985, yanchor: "top" },
      margin: { l: 84, r: 60, t: 28 + 19 * lines.length + legend, b: 60 },
    },
  };
  const address = await Plotly.toImage(figure, { format, ...PICTURE, scale: format === "png" ? 2 : 1 });
  const content = await (await fetch(address)).blob();
  download(`${picture.file()}.${format}`, content, content.type);
}

function quoted(text) {
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

function saveNumbers(picture) {
  const { heads, rows } = picture.numbers();
  const lines = [
    `# ${picture.title()}`, ...[picture.origin(), `cube: ${about.name}`, ...about.cubes.map(({ made }) => (made ? `made: ${made}` : ""))].filter(Boolean).map((text) => `# ${text.replace(/\s+/g, " ")}`),
    heads.map(quoted).join(","),
    // JavaScript writes the shortest digits that read back to the same number.
    ...rows.map((row) => row.map((v) => (v === null || Number.isNaN(v) ? "" : v)).join(",")),
  ];
  download(`${picture.file()}.csv`, lines.join("\n") + "\n", "text/csv");
}

function named(index) {
  return index.unit ? `${index.name}_${spelt(index.unit)}` : index.name;
}

// A unit as a program takes it: m_per_s2, percent_g.
function spelt(unit) {
  return unit.replace("%", "percent").replace("/", "_per_").replace("²", "2").replace(/\s/, "_");
}

function mapNumbers(s, index, numbers) {
  const rows = [];
  for (let f = 0; f < SIZES.force; f++) {
    for (let t = 0; t < SIZES.period; t++) {
      rows.push([AXES.stiffness_ratio[s.ratio], AXES.pretension[f], AXES.slip_force[f], AXES.period[t], cell(numbers[index.name], s.ratio, f, t)]);
    }
  }
  return { heads: ["stiffness_ratio", `pretension_${FORCE}`, `slip_force_${FORCE}`, "period_s", named(index)], rows };
}

function sliceNumbers(s, index, shown) {
  const heads = [`pretension_${FORCE}`, ...shown.map(({ k }) => `${about.records[k].name}_${named(index)}`)];
  const rows = AXES.pretension.map((force, f) => [force, ...shown.map(({ numbers }) => cell(numbers[index.name], s.ratio, f, s.period))]);
  return { heads, rows };
}

function bestNumbers(s, index, shown) {
  const lines = shown.map(({ k, numbers }) => ({ name: about.records[k].name, k, between: searchedEverywhere(s, k), ...bestLine(s, index, numbers, k) }));
  const heads = ["period_s"], rows = AXES.period.map((period) => [period]);
  for (const { name, k, between, x, y, z } of lines) {
    heads.push(`${name}_best_pretension_${FORCE}`, `${name}_${named(index)}`);
    if (between) heads.push(`${name}_band_start_${FORCE}`, `${name}_band_end_${FORCE}`);
    AXES.period.forEach((period, t) => {
      const at = x.indexOf(period), told = searchedAt(s, k, t);
      rows[t].push(at < 0 ? null : y[at], at < 0 ? null : z[at]);
      if (between) rows[t].push(told.start, Number.isFinite(told.end) ? told.end : "inf");
    });
  }
  return { heads, rows };
}

function historyNumbers(history) {
  const units = { time: "s", ...Object.fromEntries(Object.entries(TRACES).map(([name, sent]) => [name, unitFor(sent)])) };
  const names = ["time", "displacement", "brace_displacement", "friction_force", "acceleration", "ground_acceleration"];
  const rows = Array.from(history.arrays.time, (_, k) => names.map((name) => history.arrays[name][k]));
  return { heads: names.map((name) => `${name}_${spelt(units[name])}`), rows };
}
