// Words: what stands beside a picture, for those who do not see it and for those who do.

function pointWords(s) {
  const at = pointOf(s), own = FIELDS.filter((field) => field.own && s.free && field.name in s.free);
  return [
    `period ${written(at.period, "s")}`, `stiffness ratio ${written(at.stiffness_ratio)}`, `pretension ${written(at.pretension, FORCE)}`,
    ...own.map((field) => `${field.title} ${written(s.free[field.name], field.unit)}`),
  ].join(", ");
}

function mapWords(s, k, index, numbers) {
  const values = numbers[index.name];
  let low = [Infinity], high = [-Infinity], missing = 0;
  for (let f = 0; f < SIZES.force; f++) {
    for (let t = 0; t < SIZES.period; t++) {
      const v = cell(values, s.ratio, f, t);
      if (!Number.isFinite(v)) { missing += 1; continue; }
      if (v < low[0]) low = [v, f, t];
      if (v > high[0]) high = [v, f, t];
    }
  }
  if (low.length === 1) return `No history of ${about.records[k].name} ended well here.`;
  const at = ([v, f, t]) => `${written(v, index.unit)} at ${written(AXES.period[t], "s")} and ${written(AXES.pretension[f], FORCE)}`;
  const parts = [`From ${at(low)} to ${at(high)}.`];
  if (!index.best) parts.push("This index has no best pretension.");
  if (index.neutral !== null) parts.push(`Black line: ${written(index.neutral, index.unit)}, where the damper neither helps nor harms; blue helps, red harms.`);
  const [least, most] = index.colours;
  if (least !== null && low[0] < least) parts.push(`Colours end at ${written(least, index.unit)}.`);
  if (most !== null && high[0] > most) parts.push(`Colours end at ${written(most, index.unit)}.`);
  if (missing) parts.push(`${missing} histories did not end well and are left out.`);
  return parts.join(" ");
}

function bestWords(s, k, index, numbers) {
  if (!index.best) return "This index has no best pretension.";
  const place = gridBest(s, index, numbers, s.period), told = searchedAt(s, k, s.period);
  if (place === null) return "";
  const of = `At ${written(AXES.period[s.period], "s")} the best of the cube's pretensions is ${written(AXES.pretension[place], FORCE)}: ` +
    `${written(cell(numbers[index.name], s.ratio, place, s.period), index.unit)}.`;
  if (!told || !Number.isFinite(told.value)) return of;
  const end = Number.isFinite(told.end) ? `to ${written(told.end, FORCE)}` : "without end";
  return `${of} Between them the best is ${written(told.pretension, FORCE)}: ${written(told.value, index.unit)}, ` +
    `and the response is at most 5\u00a0% above the least from ${written(told.start, FORCE)} ${end}.`;
}

function curveWords(s, k, index, numbers) {
  const here = cell(numbers[index.name], s.ratio, s.force, s.period);
  return `${about.records[k].name}: ${written(here, index.unit)} at ${written(AXES.pretension[s.force], FORCE)}. ${bestWords(s, k, index, numbers)}`;
}

function allWords(s, index, everything) {
  const at = AXES.pretension[s.force ?? 0], here = everything.map(({ numbers }) => cell(numbers[index.name], s.ratio, s.force ?? 0, s.period));
  if (!here.every(Number.isFinite)) return "Where a record has no number there is no median.";
  const bad = index.best === "most" ? Math.min(...here) : Math.max(...here);
  return `At ${written(at, FORCE)} the median is ${written(quantile(here, 0.5), index.unit)}, the worst ${written(bad, index.unit)}, of ${everything[here.indexOf(bad)].name}.`;
}

function sliceMarks(index) {
  const marks = index.best === "least" ? ["Open marks: within 5\u00a0% of the least."] : [];
  if (about.served && index.searched) marks.push("Star and band: searched between the marks.");
  if (index.name === "acceleration") marks.push("Dotted: the bare frame; dash and dots: the frame braced for good.");
  return marks.join(" ");
}

function historyWords(history) {
  const [acceleration, displacement] = history.compared;
  const words = `Peaks of the motion between samples too: ${written(acceleration.history, acceleration.unit)}` +
    ` and ${written(displacement.history, displacement.unit)}.`;
  if (acceleration.cube === null) return `${words} The cube has no such cell: its maps are of the nearest.`;
  const off = Math.abs(acceleration.history - acceleration.cube) / Math.max(Math.abs(acceleration.cube), 1e-300);
  return off < 1e-9
    ? `${words} The cube's cell says the same.`
    : `${words} The cube's cell says ${written(acceleration.cube, acceleration.unit)}, ${written(100 * off, "%")} off.`;
}
