// Pieces of the page: elements, tables, and the words that all pages share.

const byId = (id) => document.getElementById(id);

function unitOf(index) {
  return index.unit ? `, ${index.unit}` : "";
}

function originWords(k) {
  const r = about.records[k];
  const parts = [r.source || r.event];
  if (r.pga !== null) parts.push(`PGA ${written(shownIn(r.pga, "g"), unitFor("g"))}`);
  if (r.scale_factor !== null && r.scale_factor !== 1) parts.push(`the recorded motion times ${written(r.scale_factor)}`);
  if (r.duration !== null) parts.push(`${written(r.duration, "s")} long`);
  return parts.filter(Boolean).join("; ");
}

// The drawing library reads some HTML in texts; names from files are to stand as they are.
function plain(text) {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
}

function table(caption, heads, rows) {
  const made = element("table");
  made.append(element("caption", caption));
  const line = element("tr");
  heads.forEach((head) => { const th = element("th", head); th.scope = "col"; line.append(th); });
  made.append(line);
  for (const row of rows) {
    const tr = element("tr");
    row.forEach((text, k) => {
      const td = element(k ? "td" : "th", text);
      if (!k) td.scope = "row";
      tr.append(td);
    });
    made.append(tr);
  }
  const scroll = element("div");
  scroll.className = "scroll";
  scroll.tabIndex = 0;
  scroll.setAttribute("role", "group");
  scroll.setAttribute("aria-label", caption);
  scroll.append(made);
  return scroll;
}

function element(tag, text) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  return made;
}
