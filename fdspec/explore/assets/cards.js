// Cards: a picture with its heading, its words and its downloads.

const cards = new Map();

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
  figure.append(head, plot, ...(picture.below ? picture.below() : []), words);
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
  made.width = made.plotted.clientWidth;
  await Plotly.react(made.plotted, data, drawn, CONFIG);
  if (first) {
    connectPlot(made);
    refit();
  }
}

// On a wide screen a card more or less changes the width of those that stand already.
function refit() {
  for (const made of cards.values()) {
    if (!made.drawn || made.plotted.clientWidth === made.width) continue;
    made.width = made.plotted.clientWidth;
    Plotly.Plots.resize(made.plotted);
  }
}

// A click is where the button goes up where it went down: a surface that was turned was not clicked on.
const DRAG = 5;
function connectPlot(made) {
  let down = null, moved = false, pending = null;
  made.plotted.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; moved = false; pending = null; }, true);
  addEventListener("pointermove", (event) => {
    if (down && event.buttons && Math.hypot(event.clientX - down[0], event.clientY - down[1]) > DRAG) moved = true;
  }, true);
  // A surface tells of a click while the button is still down.
  addEventListener("pointerup", () => {
    const point = pending;
    down = pending = null;
    if (point && !moved) made.click(point);
  }, true);
  if (made.click) made.plotted.on("plotly_click", (event) => {
    if (down) pending = event.points[0];
    else if (!moved) made.click(event.points[0]);
  });
  made.plotted.on("plotly_relayout", (change) => made.relayed?.(change));
}

function discard(id) {
  const made = cards.get(id);
  if (!made) return;
  Plotly.purge(made.plotted);
  made.figure.remove();
  cards.delete(id);
  refit();
}

function notice(text) {
  const made = element("p", text);
  made.className = "notice";
  return made;
}

function complain(error) {
  byId("status").textContent = error.message;
}

let asked = 0;
// The next frame is painted when this is done; a frame's own callback would still hold it up.
const painted = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
