// The numbers behind the pictures of single-storey frames, as tables.

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
