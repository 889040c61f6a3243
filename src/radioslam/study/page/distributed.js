// Gap to the central optimum over rounds and over bytes: two charts per team, a line per method.

const pane = { width: 560, height: 340, left: 78, right: 14, top: 12, bottom: 44 };
const least_gap = 1e-6, at_optimum = 1e-3;
const percent_of = v => `${v <= least_gap ? "≤ " : ""}${d3.format(",~r")(100 * v)} %`;
const shown_gap = v => Math.max(v, least_gap);
const decades_of = ([low, high]) => d3.range(Math.ceil(Math.log10(low) - 1e-9), Math.log10(high) + 1e-9).map(k => 10 ** k);
const steps_of = ([low, high]) => decades_of([low / 10, high]).flatMap(v => [v, 2 * v, 5 * v]).filter(v => v >= low && v <= high);

/// A colour per method, dashed on a bad network. Drawn from the last to the first, so that the first one is on
/// top where two coincide; the wide one below remains visible.
const method_names = study.distributed ? study.distributed.teams[0].runs.map(run => run.method) : [];
const method_kinds = Array.from(new Set(method_names.map(name => name.split(",")[0])));
const method_lines = method_names.map(name => ({ name, colour: `var(--method-${method_kinds.indexOf(name.split(",")[0])})`, dash: name.includes("lost") ? "6 4" : null, width: name === "asynchronous" ? 5 : 2 }));
const stroke_of = (path, line) => path.style("stroke", line.colour).style("stroke-width", line.width).style("stroke-dasharray", line.dash).style("stroke-opacity", line.width > 2 ? 0.5 : 1);

function draw_pane(parent, team, place, measure) {
  const traces = team.runs.map(run => run.trace.map(point => [point[place], shown_gap(point[2])]).filter(point => point[0] > 0));
  const bound = place === 1 ? team.bytes_of_all_graphs : null;
  const all = traces.flat().concat(bound ? [[bound, at_optimum]] : []);
  const x = d3.scaleLog().domain(d3.extent(all, p => p[0])).range([pane.left, pane.width - pane.right]);
  const y = d3.scaleLog().domain([least_gap, Math.max(10 * at_optimum, d3.max(all, p => p[1]) || 0)]).range([pane.height - pane.bottom, pane.top]);
  const svg = d3.select(parent).append("svg").attr("viewBox", `0 0 ${pane.width} ${pane.height}`).attr("role", "img").attr("aria-label", `${team.name}: gap over ${measure.name}`);
  const rule = (x1, y1, x2, y2) => svg.append("line").attr("x1", x1).attr("y1", y1).attr("x2", x2).attr("y2", y2);
  for (const v of steps_of(x.domain())) {
    rule(x(v), pane.top, x(v), pane.height - pane.bottom);
    svg.append("text").attr("x", x(v)).attr("y", pane.height - pane.bottom + 17).attr("text-anchor", "middle").text(measure.text(v));
  }
  for (const v of decades_of(y.domain())) {
    rule(pane.left, y(v), pane.width - pane.right, y(v));
    svg.append("text").attr("x", pane.left - 8).attr("y", y(v) + 4).attr("text-anchor", "end").text(percent_of(v));
  }
  rule(pane.left, y(at_optimum), pane.width - pane.right, y(at_optimum)).attr("class", "bound");
  if (bound) rule(x(bound), pane.top, x(bound), pane.height - pane.bottom).attr("class", "bound");
  svg.append("text").attr("x", pane.width - pane.right).attr("y", pane.height - 8).attr("text-anchor", "end").text(measure.name);
  const path = d3.line().x(p => x(p[0])).y(p => y(p[1]));
  team.runs.map((run, k) => [run, traces[k]]).reverse().forEach(([run, trace]) => {
    const line = method_lines.find(other => other.name === run.method), reached = run.trace.find(point => known(run.rounds_to_optimum) && point[0] >= run.rounds_to_optimum);
    stroke_of(svg.append("path").attr("d", path(trace)), line).append("title").text(run.method);
    if (reached && reached[place] > 0) svg.append("circle").attr("cx", x(reached[place])).attr("cy", y(shown_gap(reached[2]))).attr("r", 4).style("fill", line.colour).append("title").text(`${run.method}: ${format.count(run.rounds_to_optimum)} rounds, ${format.count(run.bytes_to_optimum)} bytes`);
  });
}

function write_distributed() {
  show("distributed-section");
  for (const line of method_lines) {
    const entry = d3.select(by_id("methods")).append("span");
    stroke_of(entry.append("svg").attr("viewBox", "0 0 30 10").append("path").attr("d", "M0 5H30"), line);
    entry.append("span").text(line.name);
  }
  const bytes = v => d3.format("~s")(v).replace(/([kMG]?)$/, " $1B");
  for (const team of study.distributed.teams) {
    const pair = element("div", { class: "pair" });
    by_id("distributed").append(element("h3", {}, team.name, element("small", {}, `${format.count(team.poses)} poses, ${format.count(team.factors)} factors, ${format.count(team.factors_between)} of them between robots`)), pair);
    draw_pane(pair, team, 0, { name: "rounds", text: format.count });
    draw_pane(pair, team, 1, { name: "bytes sent", text: bytes });
  }
}
