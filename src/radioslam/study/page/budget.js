// Error over the share of the verifications, by order.

const order_colours = { worth: "#0b6aa2", similarity: "#2c8a5b", random: "#a53c06" };

function draw_budget(scenario) {
  const medians = study.budget.medians.filter(m => m.scenario === scenario && known(m.ate_m));
  const all = d3.median(study.budget.missions.filter(m => m.scenario === scenario), m => m.all.ate_m);
  const shares = Array.from(new Set(medians.map(m => m.share)));
  const errors = medians.map(m => m.ate_m).concat(known(all) ? [all] : []);
  const x = d3.scaleLog().domain(d3.extent(shares)).range([frame.left, frame.width - frame.right]);
  const y = d3.scaleLog().domain(d3.extent(errors)).nice().range([frame.height - frame.bottom, frame.top]);
  const svg = d3.select(by_id("budget")).append("svg").attr("viewBox", `0 0 ${frame.width} ${frame.height}`).attr("role", "img").attr("aria-label", `${scenario}: error over verifications`);
  for (const share of shares) svg.append("text").attr("x", x(share)).attr("y", frame.height - frame.bottom + 18).attr("text-anchor", "middle").text(`${d3.format(".0f")(100 * share)} %`);
  for (const v of y.ticks(3)) {
    svg.append("line").attr("x1", frame.left).attr("x2", frame.width - frame.right).attr("y1", y(v)).attr("y2", y(v));
    svg.append("text").attr("x", frame.left - 8).attr("y", y(v) + 4).attr("text-anchor", "end").text(`${d3.format("~g")(v)} m`);
  }
  svg.append("text").attr("class", "name").attr("x", frame.left + 8).attr("y", frame.top + 12).text(scenario);
  svg.append("text").attr("x", frame.width - frame.right).attr("y", frame.height - 8).attr("text-anchor", "end").text("share of the verifications");
  const path = d3.line().x(p => x(p[0])).y(p => y(p[1]));
  if (known(all)) svg.append("path").attr("class", "linear").attr("d", path(x.domain().map(share => [share, all])));
  const ends = Object.entries(order_colours).map(([order, colour]) => {
    const points = medians.filter(m => m.order === order);
    if (points.length === 0) return null;
    svg.append("path").attr("d", path(points.map(m => [m.share, m.ate_m]))).style("stroke", colour);
    points.forEach(m => svg.append("circle").attr("cx", x(m.share)).attr("cy", y(m.ate_m)).attr("r", 3).style("fill", colour).append("title").text(`${order}, ${format.count(m.registrations)} registrations: ${d3.format(".3~g")(m.ate_m)} m`));
    const end = points[points.length - 1];
    return { name: order, x: x(end.share) + 8, y: y(end.ate_m) + 4 };
  }).filter(end => end);
  spread_labels(ends);
  ends.forEach(end => svg.append("text").attr("class", "name").attr("x", end.x).attr("y", end.y).text(end.name));
}

function write_budget() {
  show("budget-section");
  new Set(study.budget.medians.map(m => m.scenario)).forEach(draw_budget);
}
