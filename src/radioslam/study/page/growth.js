// Time of the overlap search over the number of poses and pairs kept.

const frame = { width: 760, height: 420, left: 64, right: 150, top: 14, bottom: 46 };
const curves = [
  { mode: "joint", key: "all_pairs_s", name: "all pairs, joint", colour: "#a53c06" },
  { mode: "joint", key: "prepare_s", name: "covariances, joint", colour: "#8a8f94" },
  { mode: "joint", key: "search_s", name: "search, joint", colour: "#0b6aa2" },
  { mode: "link", key: "search_s", name: "search, link", colour: "#2c8a5b" },
];
const items_of = town => 2 * town.poses + town.kept;
const points_of = curve => study.growth[curve.mode].towns.filter(town => known(town[curve.key]) && town[curve.key] > 0).map(town => [items_of(town), town[curve.key]]);

function growth_axes(svg, x, y) {
  const power = d3.format("~s"), clock = v => (v < 1 ? `${d3.format("~g")(v * 1e3)} ms` : `${d3.format("~g")(v)} s`);
  const decades = scale => scale.ticks(8).filter(v => Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-9);
  for (const v of decades(x)) {
    svg.append("line").attr("x1", x(v)).attr("x2", x(v)).attr("y1", frame.top).attr("y2", frame.height - frame.bottom);
    svg.append("text").attr("x", x(v)).attr("y", frame.height - frame.bottom + 18).attr("text-anchor", "middle").text(power(v));
  }
  for (const v of decades(y)) {
    svg.append("line").attr("x1", frame.left).attr("x2", frame.width - frame.right).attr("y1", y(v)).attr("y2", y(v));
    svg.append("text").attr("x", frame.left - 8).attr("y", y(v) + 4).attr("text-anchor", "end").text(clock(v));
  }
  svg.append("text").attr("x", frame.width - frame.right).attr("y", frame.height - 8).attr("text-anchor", "end").text("poses of both robots + pairs kept");
}

/// Moves the curves' labels apart where they would overlap.
function spread_labels(ends) {
  ends.sort((a, b) => a.y - b.y).forEach((end, k) => { if (k > 0) end.y = Math.max(end.y, ends[k - 1].y + 16); });
}

function write_growth() {
  show("growth-section");
  const lines = curves.map(curve => ({ curve, points: points_of(curve) })).filter(line => line.points.length > 1);
  const all = lines.flatMap(line => line.points);
  const x = d3.scaleLog().domain(d3.extent(all, p => p[0])).range([frame.left, frame.width - frame.right]);
  const y = d3.scaleLog().domain(d3.extent(all, p => p[1])).nice().range([frame.height - frame.bottom, frame.top]);
  const svg = d3.select(by_id("growth")).append("svg").attr("viewBox", `0 0 ${frame.width} ${frame.height}`).attr("role", "img").attr("aria-label", "seconds over poses and pairs kept");
  growth_axes(svg, x, y);
  const path = d3.line().x(p => x(p[0])).y(p => y(p[1]));
  const first = points_of(curves[2])[0], last = x.domain()[1];
  svg.append("path").attr("class", "linear").attr("d", path([first, [last, (first[1] * last) / first[0]]]));
  const ends = lines.map(({ curve, points }) => {
    svg.append("path").attr("d", path(points)).style("stroke", curve.colour);
    points.forEach(p => svg.append("circle").attr("cx", x(p[0])).attr("cy", y(p[1])).attr("r", 3).style("fill", curve.colour).append("title").text(`${format.count(Math.round(p[0]))} poses and pairs: ${d3.format(".3~g")(p[1])} s`));
    const end = points[points.length - 1];
    return { name: curve.name, x: x(end[0]) + 8, y: y(end[1]) + 4 };
  });
  spread_labels(ends);
  ends.forEach(end => svg.append("text").attr("class", "name").attr("x", end.x).attr("y", end.y).text(end.name));
}

/// Growth exponent and saving, as text.
function growth_summary() {
  const towns = study.growth.joint.towns, compared = towns.filter(town => known(town.all_pairs_s)).pop(), steep = study.growth.joint.exponent;
  const parts = [];
  if (known(steep)) parts.push(`Search time grows with (poses + pairs kept) to the power ${d3.format(".2f")(steep)}.`);
  if (compared) parts.push(`At ${format.count(compared.poses)} poses per robot the search is ${d3.format(",.0f")(compared.all_pairs_s / compared.search_s)} times faster than testing all pairs.`);
  return parts.join(" ");
}
