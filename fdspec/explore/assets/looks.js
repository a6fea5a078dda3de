// How pictures look: colours of the light and of the dark page, letters, axes.

// Of Okabe and Ito's palette; the second record differs by its dashes and marks too.
const FAMILY = 'system-ui, "Segoe UI", "DejaVu Sans", sans-serif';
// Colours of the light and of the dark page; lines reach a contrast of 3 on their ground, letters 4.5.
const LIGHT = {
  lines: ["#0072B2", "#D55E00"], ground: "#5c5c5c", limit: "#4a5866", ink: "#1b2733", paper: "#ffffff", grid: "#e3e8ec",
  space: "#f4f6f8", spaceGrid: "#c9d1d9", grey: "#aab3bd", median: "#1b2733", high: "#007a5a", worst: "#B03A00",
};
const DARK = {
  lines: ["#56B4E9", "#F0A04B"], ground: "#aab3bd", limit: "#aab3bd", ink: "#e8edf2", paper: "#1a222b", grid: "#34404c",
  space: "#222c36", spaceGrid: "#4a5866", grey: "#6f7c89", median: "#e8edf2", high: "#2fc79a", worst: "#F0A04B",
};
let LOOK = LIGHT, FONT, RECORD_LINES, FLOOR, BRACE, GROUND, LIMIT;
function setLook(look) {
  LOOK = look;
  FONT = { family: FAMILY, size: 12, color: look.ink };
  RECORD_LINES = [
    { color: look.lines[0], dash: "solid", symbol: "circle" },
    { color: look.lines[1], dash: "dash", symbol: "square" },
  ];
  [FLOOR, BRACE] = look.lines;
  GROUND = look.ground;
  LIMIT = look.limit;
}
setLook(LIGHT);
// No buttons over the pictures, which keys do not reach: the page has its own. No zoom by dragging where a
// finger drags to scroll.
const TOUCH = matchMedia("(pointer: coarse)").matches;
const CONFIG = { plotGlPixelRatio: Math.min(window.devicePixelRatio, 2), displayModeBar: false, responsive: true, doubleClick: "reset", scrollZoom: false };

function layout(more) {
  return {
    font: FONT, paper_bgcolor: LOOK.paper, plot_bgcolor: LOOK.paper, showlegend: false, uirevision: "kept",
    separators: ".\u2009", dragmode: TOUCH ? false : "zoom", margin: { l: 58, r: 12, t: 8, b: 42 },
    // Of the page's own colours: those of the marks would carry no letters that can be read.
    hoverlabel: { font: FONT, bgcolor: LOOK.paper, bordercolor: LOOK.limit }, ...more,
  };
}

// Numbers at axes and colours: 500 000, never 500k.
const NUMBERS = { exponentformat: "none", separatethousands: true };
// As many at a map's axes as at those of its surface, so that both carry the same numbers.
const TICKS = 6;

function axis(title, more) {
  return { title: { text: title, standoff: 6 }, gridcolor: LOOK.grid, zeroline: false, automargin: true, ...NUMBERS, ticks: "outside", ticklen: 3, ...more };
}

// A long title in lines that fit the height of a picture.
function folded(text, letters = 30) {
  const lines = [""];
  for (const word of text.split(" ")) {
    if (lines.at(-1) && lines.at(-1).length + word.length >= letters) lines.push("");
    lines[lines.length - 1] += (lines.at(-1) ? " " : "") + word;
  }
  return lines.join("<br>");
}

// What many say together, as fdspec.measures.ensemble does: median, 84th percentile (linear between members), worst.
function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b), at = share * (sorted.length - 1), low = Math.floor(at);
  return low + 1 < sorted.length ? sorted[low] + (at - low) * (sorted[low + 1] - sorted[low]) : sorted[low];
}
