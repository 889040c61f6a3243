// Tables: robots, frames, range biases, closures by kind and reason, time per stage.

/// columns: [{name, value(item), text(item) or node(item), number}]
function sortable_table(columns_shown, items, decorate) {
  const order = { column: null, sign: 1 };
  const body = element("tbody", {});
  const heads = columns_shown.map(c => element("th", { scope: "col", class: c.number ? "number" : null, title: c.title || null },
    element("button", { type: "button", onclick: () => sort_by(c) }, c.name)));
  const fill = () => {
    const sorted = [...items];
    if (order.column) sorted.sort((a, b) => order.sign * compare(order.column.value(a), order.column.value(b)));
    body.replaceChildren(...sorted.map(item => decorate(element("tr", {}, ...columns_shown.map(c => cell(c, item))), item)));
    heads.forEach((head, i) => head.setAttribute("aria-sort", order.column !== columns_shown[i] ? "none" : order.sign > 0 ? "ascending" : "descending"));
  };
  const sort_by = c => {
    order.sign = order.column === c ? -order.sign : c.number ? -1 : 1;
    order.column = c;
    fill();
  };
  fill();
  return { table: element("table", {}, element("thead", {}, element("tr", {}, ...heads)), body), fill };
}

const cell = (c, item) => element("td", { class: c.number ? "number" : c.id ? "id" : c.long ? "text" : null }, ...(c.node ? c.node(item) : [c.text(item)]));

function compare(a, b) {
  if (typeof a === "string") return d3.ascending(a, b);
  return known(a) && known(b) ? a - b : known(a) ? 1 : known(b) ? -1 : 0;
}

function robot_columns() {
  const some = key => robots.some(r => known(r[key]));
  const number = (name, value, text, title) => ({ name, value, text: r => text(value(r)), number: true, title });
  const list = [{ name: "robot", value: r => r.id, id: true, node: r => [element("span", { class: "swatch", style: { background: robot_colour(r.index) } }), r.id] }];
  // Errors first: on a narrow screen the rest is beyond the edge.
  if (report.accuracy)
    list.push(number("ATE RMSE (m)", r => r.ate && r.ate.rmse_m, format.metres), number("median (m)", r => r.ate && r.ate.median_m, format.metres),
      number("p90 (m)", r => r.ate && r.ate.p90_m, format.metres));
  if (some("sigma_median_m")) list.push(number("σ median (m)", r => r.sigma_median_m, format.metres, "of position, after the best rigid motion of the whole team"));
  if (robots.some(r => r.dead_reckoning)) list.push(number("dead reckoning (m)", r => r.dead_reckoning && r.dead_reckoning.rmse_m, format.metres, "RMSE, after its own alignment"));
  if (report.accuracy) list.push(number("covered", r => r.coverage, format.percent, "ratio of the true poses"));
  if (report.components.length > 1) list.push(number("frame", r => (r.stranded ? null : r.component + 1), format.count));
  if (robots.some(r => r.stranded)) list.push({ name: "placed", value: r => (r.stranded ? "no" : "yes"), text: r => (r.stranded ? "no" : "yes") });
  list.push(number("keyframes", r => r.keyframes, format.count), number("path length (m)", r => r.walked_m, format.metres));
  if (some("fixes"))
    list.push(number("fixes used", r => r.fixes && r.fixes.used, format.count, "position fixes that agree with the estimate"),
      number("fixes rejected", r => r.fixes && r.fixes.rejected, format.count, "position fixes that contradict the estimate"));
  if (robots.some(r => r.yaw_drift_per_m_rad)) list.push(number("yaw drift (°/100 m)", r => r.yaw_drift_per_m_rad * 100, v => minus(d3.format("+.2f")((v * 180) / Math.PI)), "estimated"));
  if (robots.some(r => r.scale_error)) list.push(number("scale error", r => r.scale_error, v => minus(`${d3.format("+.2f")(v * 100)} %`), "estimated"));
  return list;
}

function write_robots() {
  if (!robots.length) return;
  show("robots-section");
  const place = by_id("robots-table");
  if (robots.length > 20) place.classList.add("tall");
  const { table, fill } = sortable_table(robot_columns(), robots, (line, robot) => {
    line.addEventListener("mouseenter", () => highlight(robot.index));
    line.addEventListener("mouseleave", () => highlight(null));
    return line;
  });
  place.append(table);
  changes.on("theme.robots", fill);
}

function write_frames() {
  if (!report.transforms.length) return;
  show("frames-section");
  const column = (name, value, text) => ({ name, value, text: t => minus(text(value(t))), number: true });
  const { table } = sortable_table([
    { name: "in the frame of", value: t => t.robot_i, text: t => t.robot_i },
    { name: "frame of", value: t => t.robot_j, text: t => t.robot_j },
    column("x (m)", t => t.translation_m[0], d3.format(".2f")),
    column("y (m)", t => t.translation_m[1], d3.format(".2f")),
    ...(report.dimension === 3 ? [column("z (m)", t => t.translation_m[2], d3.format(".2f"))] : []),
    column("heading (°)", t => t.yaw_rad, format.degrees),
    column("σ of position (m)", t => t.sigma_position_m, format.metres),
    column("σ of heading (°)", t => t.sigma_yaw_rad, format.degrees),
  ], report.transforms, line => line);
  by_id("frames-table").append(table);
}

function write_range_biases() {
  if (!report.range_biases.length) return;
  show("biases-section");
  const metres = d3.format("+.3f");
  const { table } = sortable_table([
    { name: "from", value: b => b.end_i, text: b => b.end_i },
    { name: "to", value: b => b.end_j, text: b => b.end_j },
    { name: "bias (m)", value: b => b.bias_m, text: b => minus(metres(b.bias_m)), number: true },
    { name: "σ (m)", value: b => b.sigma_m, text: b => format.metres(b.sigma_m), number: true },
    { name: "ranges", value: b => b.ranges, text: b => format.count(b.ranges), number: true },
  ], report.range_biases, line => line);
  by_id("biases-table").append(table);
}

function write_angle_checks() {
  if (!report.angle_checks.length) return;
  show("angles-section");
  const share = d3.format(".0%");
  const { table } = sortable_table([
    { name: "receiver", value: c => c.receiver, text: c => c.receiver },
    { name: "transmitter", value: c => c.transmitter, text: c => c.transmitter },
    { name: "poses", value: c => c.pose, text: c => (c.pose === "claim" ? "self-reported" : "estimated") },
    { name: "angles", value: c => c.measurements, text: c => format.count(c.measurements), number: true },
    { name: "median likelihood", value: c => c.median_weight, text: c => d3.format(".2f")(c.median_weight), number: true },
    { name: "beyond threshold", value: c => c.share_beyond, text: c => share(c.share_beyond), number: true },
    { name: "result", value: c => c.contradicted, text: c => (c.contradicted ? "contradicted" : "agrees") },
  ], report.angle_checks, line => line);
  by_id("angles-table").append(table);
}

function write_closure_bars() {
  const kinds = Array.from(new Set(groups.map(g => g.kind))), counted = (kind, status) => total(groups.filter(g => g.kind === kind && g.status === status), g => g.count);
  const longest = d3.max(kinds, kind => counted(kind, "accepted") + counted(kind, "rejected"));
  const bar = (count, group) => element("span", { style: { width: `${(100 * count) / longest}%`, background: closure_colour(group) } });
  const rows = kinds.flatMap(kind => {
    const accepted = counted(kind, "accepted"), rejected = counted(kind, "rejected");
    return [element("span", {}, kind), element("span", { class: "bars" }, bar(accepted, { kind, status: "accepted" }), bar(rejected, { kind, status: "rejected" })),
      element("span", {}, `${format.count(accepted)} accepted, ${format.count(rejected)} rejected`)];
  });
  by_id("closures-bars").replaceChildren(element("div", { class: "kinds" }, ...rows));
}

function write_closures() {
  if (!closures_total) return;
  show("closures-section");
  write_closure_bars();
  changes.on("theme.closures", write_closure_bars);
  const { table } = sortable_table([
    { name: "kind", value: r => r.kind, text: r => r.kind },
    { name: "status", value: r => r.status, text: r => r.status },
    { name: "reason", value: r => r.reason, text: r => r.reason || missing, long: true },
    { name: "count", value: r => r.count, text: r => format.count(r.count), number: true },
    { name: "median statistic", value: r => r.statistic_median, text: r => (known(r.statistic_median) ? d3.format(".3~g")(r.statistic_median) : missing), number: true, title: "squared normalised residual; rejected before the joint estimate: lidar, inlier ratio; sequence, mean residual in metres" },
  ], report.closures.reasons, line => line);
  by_id("closures-table").append(table);
}

function write_compared_closures() {
  const { compared } = report.closures;
  if (!compared.length) return;
  show("truth-section");
  const number = (name, key, title) => ({ name, value: c => c[key], text: c => (known(c[key]) ? format.count(c[key]) : missing), number: true, title });
  const angles = compared.some(c => known(c.direct_found)) ? [number("direct path found", "direct_found", "accepted angles whose likeliest path is direct"),
    number("wrong path", "wrong_path", "accepted angles of which another path is direct"), number("none direct", "none_direct", "accepted angles without a direct path")] : [];
  const { table } = sortable_table([
    { name: "kind", value: c => c.kind, text: c => c.kind },
    number("accepted", "accepted"), number("true", "true_accepted", "of the accepted ones"),
    number("rejected", "rejected"), number("true", "true_rejected", "of the rejected ones"), ...angles,
  ], compared, line => line);
  by_id("truth-table").append(table);
}

function write_timings() {
  if (!report.timings.length) return;
  show("timings-section");
  const longest = d3.max(report.timings, t => t.seconds) || 1;
  const rows = report.timings.flatMap(t => [element("span", { class: "name" }, t.stage),
    element("span", { class: "bar", style: { width: `${(100 * t.seconds) / longest}%` } }), element("span", { class: "number" }, format.stage_seconds(t.seconds))]);
  const sum = ["total", "", format.stage_seconds(seconds_total)].map((text, i) => element("span", { class: i === 2 ? "number total" : "total" }, text));
  by_id("timings").append(element("div", { class: "stages" }, ...rows, ...sum));
}

function write_counts() {
  const counts = Object.entries(report.counts);
  if (!counts.length) return;
  show("counts-section");
  by_id("counts").append(...counts.flatMap(([name, value]) => [element("dt", {}, name.replace(/_/g, " ")), element("dd", {}, known(value) ? d3.format(",~r")(value) : missing)]));
}
