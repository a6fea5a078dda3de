// What every page has: units, theme, link, back button, print.

function numberOf(text) {
  const value = text === null || text.trim() === "" ? NaN : Number(text);
  return Number.isFinite(value) ? value : null;
}

// A view that was chosen gets a place of its own behind the back button; a slider that is dragged does not.
let chosen = false;
function toAddress() {
  const address = addressOf(state);
  if (address === location.hash) return;
  if (chosen && location.hash) history.pushState(null, "", address);
  else history.replaceState(null, "", address);
  chosen = false;
}

// The back button, and a link that is pasted into an open page.
addEventListener("popstate", () => {
  if (location.hash !== addressOf(state)) readAddress();
});

function options(select, names, first = 0) {
  names.forEach((name, k) => {
    const made = element("option", name);
    made.value = String(k + first);
    select.append(made);
  });
}

// Other units are another view of the same numbers, so the address says them and the page reads it anew.
function unitControls() {
  for (const [kind, { title, units }] of Object.entries(KINDS)) {
    const field = element("div"), label = element("label", title), select = element("select");
    select.id = `unit-${kind}`;
    label.htmlFor = select.id;
    options(select, Object.keys(units));
    for (const option of select.options) option.value = option.textContent;
    select.addEventListener("change", () => {
      const told = Object.fromEntries(new URLSearchParams(addressOf(state).slice(1)));
      for (const one of Object.keys(KINDS)) delete told[one];
      chosenUnits[kind] = select.value;
      unitsInto(told);
      history.pushState(null, "", "#" + new URLSearchParams(told));
      readAddress();
    });
    field.className = "field";
    field.append(label, select);
    byId("unit-fields").append(field);
  }
}

function unitsFromState() {
  for (const kind of Object.keys(KINDS)) byId(`unit-${kind}`).value = chosenUnits[kind];
}

function connectPage() {
  byId("link").addEventListener("click", copyLink);
  byId("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  byId("controls").addEventListener("submit", (event) => event.preventDefault());
  unitControls();
}

function start() {
  theme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  connect();
  show();
}

async function copyLink() {
  const button = byId("link");
  try {
    await navigator.clipboard.writeText(location.href);
    button.textContent = "Copied";
  } catch {
    button.textContent = "See the address bar";
  }
  setTimeout(() => { button.textContent = "Copy link"; }, 2000);
}

async function redraw(kind) {
  for (const [id, made] of cards) if (!kind || id.startsWith(kind)) await draw(made);
}

// Light or dark, as the system has it until the reader says otherwise.
function theme(name) {
  document.documentElement.dataset.theme = name;
  setLook(name === "dark" ? DARK : LIGHT);
  byId("theme").textContent = name === "dark" ? "Light" : "Dark";
  redraw().catch(complain);
}

// On paper pictures have the size of the page, not of the window, and the ground is white. Sizes are those of page.css.
const PAPER = { map: [660, 330], curve: [660, 250], history: [660, 420], profile: [312, 300] };
let themeOnScreen = null;
addEventListener("beforeprint", () => {
  themeOnScreen = document.documentElement.dataset.theme;
  document.documentElement.dataset.theme = "light";
  setLook(LIGHT);
  for (const made of cards.values()) {
    const { data, layout: drawn } = made.plot(), [width, height] = PAPER[made.look];
    Plotly.react(made.plotted, data, { ...drawn, width, height, autosize: false }, CONFIG);
  }
  // Who reads it on paper cannot open what is closed; where the numbers come from must not be missing.
  const origin = byId("origin-of-numbers");
  if (origin) { origin.dataset.was = origin.open ? "open" : ""; origin.open = true; }
});
addEventListener("afterprint", () => {
  const origin = byId("origin-of-numbers");
  if (origin) origin.open = origin.dataset.was === "open";
  theme(themeOnScreen);
});
