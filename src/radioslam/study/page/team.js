// What a team sends over its size, losses and partitions, and what it knows of itself on its way.

const sent_ways = [
  { key: "bytes", name: "agents", colour: "#0b6aa2" },
  { key: "bytes_at_one", name: "logs at one", colour: "#8a8f94" },
  { key: "bytes_to_all", name: "logs to all", colour: "#2c8a5b" },
  { key: "bytes_of_descriptors", name: "descriptors", colour: "#a53c06" },
  { key: "bytes_boxes_first", name: "boxes first", colour: "#7a4fa3" },
];
const way_errors = [
  { key: "run_ate_m", name: "run", colour: "#8a8f94" },
  { key: "agent_ate_m", name: "worst agent", colour: "#0b6aa2" },
  { key: "way_ate_m", name: "on the way", colour: "#a53c06" },
];
const sent_of = (of, key) => d3.median(of.seeds, s => s[key]) / (of.robots * of.path_m);
const error_of = (of, key) => d3.median(of.seeds.filter(s => known(s[key])), s => s[key]);

/// `axis`: key of the cases, its name and text, and whether it is logarithmic; `measure`: lines, value, unit.
function draw_team(parent, of_cases, axis, measure) {
  const lines = measure.lines.map(line => ({ ...line, points: of_cases.map(of => [of[axis.key], measure.value(of, line.key)]).filter(p => p[1] > 0) }));
  const all = lines.flatMap(line => line.points);
  if (all.length === 0) return;
  const x = (axis.log ? d3.scaleLog() : d3.scaleLinear()).domain(d3.extent(all, p => p[0])).range([frame.left, frame.width - frame.right]);
  const y = d3.scaleLog().domain(d3.extent(all, p => p[1])).nice().range([frame.height - frame.bottom, frame.top]);
  const svg = d3.select(parent).append("svg").attr("viewBox", `0 0 ${frame.width} ${frame.height}`).attr("role", "img").attr("aria-label", `${measure.unit} over ${axis.name}`);
  for (const of of of_cases) svg.append("text").attr("x", x(of[axis.key])).attr("y", frame.height - frame.bottom + 18).attr("text-anchor", "middle").text(axis.text(of[axis.key]));
  for (const v of y.ticks().filter(v => "125".includes(v.toExponential()[0]))) {
    svg.append("line").attr("x1", frame.left).attr("x2", frame.width - frame.right).attr("y1", y(v)).attr("y2", y(v));
    svg.append("text").attr("x", frame.left - 8).attr("y", y(v) + 4).attr("text-anchor", "end").text(v < 1 ? String(v) : d3.format("~s")(v));
  }
  svg.append("text").attr("x", frame.width - frame.right).attr("y", frame.height - 8).attr("text-anchor", "end").text(axis.name);
  svg.append("text").attr("class", "name").attr("x", frame.left).attr("y", frame.top - 6).text(measure.unit);
  const path = d3.line().x(p => x(p[0])).y(p => y(p[1]));
  const ends = lines.filter(line => line.points.length > 0).map(({ name, colour, points }) => {
    svg.append("path").attr("d", path(points)).style("stroke", colour);
    points.forEach(p => svg.append("circle").attr("cx", x(p[0])).attr("cy", y(p[1])).attr("r", 3).style("fill", colour).append("title").text(`${name}, ${axis.text(p[0])}: ${d3.format(".3~g")(p[1])} ${measure.unit}`));
    const end = points[points.length - 1];
    return { name, x: x(end[0]) + 8, y: y(end[1]) + 4 };
  });
  spread_labels(ends);
  ends.forEach(end => svg.append("text").attr("class", "name").attr("x", end.x).attr("y", end.y).text(end.name));
}

function write_team() {
  show("team-section");
  const cases = study.team.cases, first = cases[0], like_first = cases.filter(of => of.robots === first.robots && of.path_m === first.path_m);
  const axes = [
    [like_first.filter(of => of.partition_s === 0), { key: "loss", name: "messages lost", text: d3.format(".0%") }],
    [like_first.filter(of => of.loss === 0), { key: "partition_s", name: "partition", text: v => `${v} s` }],
    [cases.filter(of => of.path_m !== first.path_m), { key: "robots", name: "robots", text: String, log: true }],
  ];
  for (const [of_cases, axis] of axes) {
    const pair = element("div", { class: "pair" });
    by_id("team").append(pair);
    draw_team(pair, of_cases, axis, { lines: sent_ways, value: sent_of, unit: "bytes per robot and metre" });
    draw_team(pair, of_cases, axis, { lines: way_errors, value: error_of, unit: "m" });
  }
}
