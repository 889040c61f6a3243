// Top of the page: the mission, its accuracy, and notes.

function figure(name, value, unit, detail) {
  const shown_value = element("dd", { class: "figure" }, value, ...(unit ? [element("small", {}, unit)] : []));
  return element("div", {}, element("dt", {}, name), shown_value, ...(detail ? [element("dd", { class: "detail" }, detail)] : []));
}

const spread = s => `median ${format.metres(s.median_m)} · p90 ${format.metres(s.p90_m)}`;

function accuracy_figures(accuracy) {
  const figures = [];
  if (accuracy.ate) figures.push(figure("ATE (RMSE)", format.metres(accuracy.ate.rmse_m), "m", spread(accuracy.ate)));
  if (accuracy.dead_reckoning)
    figures.push(figure("Dead reckoning (RMSE)", format.metres(accuracy.dead_reckoning.rmse_m), "m", spread(accuracy.dead_reckoning)));
  if (known(accuracy.ratio))
    figures.push(figure("ATE / dead reckoning", d3.format(accuracy.ratio < 0.1 ? ".3f" : ".2f")(accuracy.ratio), "", `${format.percent(accuracy.coverage)} of the truth covered`));
  return figures;
}

function walk_figures() {
  if (!robots.length) return [];
  const walked = total(robots, r => r.walked_m || 0), sigmas = robots.map(r => r.sigma_median_m).filter(known);
  const figures = [figure("Path length", format.metres(walked), "m", `${format.count(total(robots, r => r.keyframes))} keyframes`)];
  if (sigmas.length) figures.push(figure("Position σ within the team, median", format.metres(d3.median(sigmas)), "m", robots.length > 1 ? `worst robot ${format.metres(d3.max(sigmas))} m` : "as estimated"));
  return figures;
}

function run_figures() {
  const figures = [];
  if (alternatives.length)
    figures.push(figure("Weight of this hypothesis", format.percent(report.weight), "", format.plural(alternatives.length, "other hypothesis", "other hypotheses")));
  const { kept, pairs, distances_evaluated } = report.candidates;
  if (known(pairs) && pairs > 0)
    figures.push(figure("Pairs kept", format.fine_percent(kept / pairs), "", `${format.count(kept)} of ${format.count(pairs)}; ${format.count(distances_evaluated)} distances evaluated`));
  if (closures_total)
    figures.push(figure("Closures accepted", format.count(accepted_total), `of ${format.count(closures_total)}`, `${format.count(closures_total - accepted_total)} rejected`));
  if (seconds_total > 0) {
    const [value, unit] = format.seconds(seconds_total).split(/ (?=m?s$)/);
    const slowest = report.timings.reduce((a, b) => (a.seconds > b.seconds ? a : b));
    figures.push(figure("Time", value, unit || "", `${format.percent(slowest.seconds / seconds_total)} of it ${slowest.stage}`));
  }
  return figures;
}

function write_facts() {
  const facts = [format.plural(robots.length, "robot") + (robots.length > 0 && robots.length <= few_robots ? ` (${robots.map(r => r.id).join(", ")})` : ""),
    report.dimension === 3 ? "in space" : "in the plane", format.plural(total(robots, r => r.keyframes), "keyframe"),
    `${format.metres(total(robots, r => r.walked_m || 0))} m travelled`];
  const duration = d3.max(robots, r => r.duration_s);
  if (duration > 0) facts.push(`longest recording ${format.duration(duration)}`);
  by_id("facts").textContent = facts.join(" · ");
}

/// One box per kind; of several notes the first, which unfolds the others.
function note_box(notes) {
  if (notes.length === 1) return element("li", {}, notes[0]);
  const count = element("span", { class: "count" }, `${format.count(notes.length)} of this kind`);
  return element("li", {}, element("details", {}, element("summary", {}, notes[0], " ", count),
    element("ul", {}, ...notes.slice(1).map(note => element("li", {}, note)))));
}

function write_notes() {
  by_id("notes").append(...report.notes.map(note_box));
}

function write_headline() {
  document.title = report.mission ? `${report.mission} – radioslam` : "radioslam report";
  by_id("mission").textContent = report.mission || "Unnamed mission";
  write_facts();
  by_id("headline").append(...(report.accuracy ? accuracy_figures(report.accuracy) : walk_figures()), ...run_figures());
  write_notes();
}
