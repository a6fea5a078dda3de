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
