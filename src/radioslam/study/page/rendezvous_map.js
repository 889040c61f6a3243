// The floor of a replay at a moment: where robots are, where they take themselves to be, who asks and who walks to whom.

const ground = { size: 660, left: 34, right: 10, top: 10, bottom: 40 };
const fading = { steps: 36, parts: 6, faint: 0.16 };  // iterations over which a track fades, in parts of one opacity
const robot_sign = "M9 0L-6 5.5L-3 0L-6 -5.5Z";       // heading 0
const star_sign = d3.symbol().type(d3.symbolStar).size(52)();
const labelled_robots = 12;

/// r00001 is r1.
const short_name = name => name.replace(/^(\D*)0+(?=\d)/, "$1");
function robot_colour(k, robots) {
  if (robots <= shades) return `var(--method-${k})`;
  return d3.interpolateViridis(dark_scheme.matches ? 0.22 + (0.78 * k) / (robots - 1) : (0.83 * k) / (robots - 1));
}

/// Metres to pixels, the same along both axes.
function ground_scales(replay) {
  const k = (ground.size - ground.left - ground.right) / replay.side_m;
  return { k, x: v => ground.left + k * v, y: v => ground.top + k * (replay.side_m - v), height: ground.top + k * replay.side_m + ground.bottom };
}

function draw_ground(parent, replay) {
  const { k, x, y, height } = ground_scales(replay), side = replay.side_m;
  const svg = d3.select(parent).append("svg").attr("viewBox", `0 0 ${ground.size} ${height}`).attr("role", "img").attr("tabindex", 0);
  for (const v of d3.ticks(0, side, 6)) {
    svg.append("line").attr("class", "grid").attr("x1", x(v)).attr("x2", x(v)).attr("y1", y(0)).attr("y2", y(side));
    svg.append("line").attr("class", "grid").attr("x1", x(0)).attr("x2", x(side)).attr("y1", y(v)).attr("y2", y(v));
    svg.append("text").attr("x", x(v)).attr("y", y(0) + 17).attr("text-anchor", "middle").text(v);
    svg.append("text").attr("x", x(0) - 7).attr("y", y(v) + 4).attr("text-anchor", "end").text(v);
  }
  svg.append("text").attr("x", x(side)).attr("y", y(0) + 33).attr("text-anchor", "end").text("metres");
  for (const [x0, y0, x1, y1] of replay.boxes) svg.append("rect").attr("class", "box").attr("x", x(x0)).attr("y", y(y1)).attr("width", k * (x1 - x0)).attr("height", k * (y1 - y0));
  svg.append("rect").attr("class", "wall").attr("x", x(0)).attr("y", y(side)).attr("width", k * side).attr("height", k * side);
  return svg;
}

/// True positions so far, fainter the longer ago.
function draw_track(layer, places, colour) {
  const line = d3.line(), recent = Math.max(0, places.length - fading.steps), part = fading.steps / fading.parts;
  const stroke = (points, opacity) => layer.append("path").attr("class", "track").attr("d", line(points)).style("stroke", colour).style("stroke-opacity", opacity);
  if (recent > 0) stroke(places.slice(0, recent + 1), fading.faint);
  for (let end = places.length - 1, age = 0; end > recent; end -= part, ++age)
    stroke(places.slice(Math.max(recent, end - part), end + 1), fading.faint + (0.9 - fading.faint) * (1 - age / fading.parts));
}

/// Robots that have come to see another one at an iteration.
const newly_met = (replay, i) => d3.range(replay.robots.length).filter(k => replay.iterations[i].seeing[k] && !(i > 0 && replay.iterations[i - 1].seeing[k]));

function draw_estimate(layer, [x, y], [ex, ey], sigma_px, colour) {
  if (sigma_px > 0) layer.append("circle").attr("class", "sigma").attr("cx", ex).attr("cy", ey).attr("r", sigma_px).style("fill", colour).style("stroke", colour);
  layer.append("line").attr("class", "offset").attr("x1", x).attr("y1", y).attr("x2", ex).attr("y2", ey).style("stroke", colour);
  layer.append("circle").attr("class", "estimate").attr("cx", ex).attr("cy", ey).attr("r", 4.5).style("stroke", colour);
}

/// From a robot that walks to the one that it walks to, with an arrowhead before that one.
function draw_way(layer, [x, y], [tx, ty]) {
  const length = Math.hypot(tx - x, ty - y), gap = Math.min(14, length / 2), angle = (Math.atan2(ty - y, tx - x) * 180) / Math.PI;
  const way = layer.append("g").attr("class", "way").attr("transform", `translate(${x},${y}) rotate(${angle})`);
  way.append("line").attr("x2", length - gap);
  way.append("path").attr("d", `M${length - gap} 0l-9 -4v8Z`);
}

function draw_robot(layer, [x, y], yaw, asking, colour) {
  const robot = layer.append("g").attr("class", "robot").attr("transform", `translate(${x},${y})`);
  if (asking) robot.append("circle").attr("class", "asking").attr("r", 13);
  robot.append("path").attr("d", robot_sign).attr("transform", `rotate(${(-yaw * 180) / Math.PI})`).style("fill", colour);
  return robot;
}

function draw_label(layer, [x, y], text) {
  const side = x > ground.size - 70 ? -1 : 1;
  layer.append("text").attr("class", "haloed label").attr("x", x + 15 * side).attr("y", y - 8).attr("text-anchor", side < 0 ? "end" : "start").text(text);
}

function draw_moment(layer, replay, at) {
  layer.selectAll("*").remove();
  const { k, x, y } = ground_scales(replay), now = replay.iterations[at], past = replay.iterations.slice(0, at + 1), robots = replay.robots.length;
  const place = p => [x(p[0]), y(p[1])], name = r => short_name(replay.robots[r]), each = draw => now.truth.forEach((truth, r) => draw(place(truth), r, robot_colour(r, robots)));
  each(([px, py]) => layer.append("circle").attr("class", "range").attr("cx", px).attr("cy", py).attr("r", k * replay.sensing_range_m));
  each((_, r, colour) => draw_track(layer, past.map(moment => place(moment.truth[r])), colour));
  past.forEach((moment, i) => newly_met(replay, i).forEach(r => {
    const [px, py] = place(moment.truth[r]);
    layer.append("path").attr("class", "star").attr("d", star_sign).attr("transform", `translate(${px},${py})`).style("fill", robot_colour(r, robots)).style("opacity", at - i > fading.steps ? 0.5 : 1).append("title").text(`${name(r)} met another, iteration ${i + 1}`);
  }));
  each((p, r) => { if (now.serving[r] >= 0) draw_way(layer, p, place(now.truth[now.serving[r]])); });
  each((p, r, colour) => draw_robot(layer, p, now.truth[r][2], now.asking[r], colour).append("title").text(name(r)));
  each((p, r, colour) => { if (now.estimate[r].every(known)) draw_estimate(layer, p, place(now.estimate[r]), k * (now.sigma_m[r] || 0), colour); });
  each((p, r) => { if (now.asking[r] || robots <= labelled_robots) draw_label(layer, p, `${name(r)}${now.asking[r] ? " asks" : ""}`); });
}

/// What the signs mean.
function write_map_key(parent) {
  const entry = (text, draw) => {
    const item = d3.select(parent).append("span");
    draw(item.append("svg").attr("viewBox", "-15 -11 30 22").attr("aria-hidden", "true"));
    item.append("span").text(text);
  };
  const ink = "var(--quiet)";
  entry("true position and heading", svg => svg.append("path").attr("d", robot_sign).style("fill", ink));
  entry("estimate, joined to the truth; shaded: 1 σ", svg => draw_estimate(svg, [-14, 5], [3, 0], 10, ink));
  entry("sensing range", svg => svg.append("circle").attr("class", "range").attr("r", 10));
  entry("asks for a rendezvous", svg => svg.append("circle").attr("class", "asking").attr("r", 9));
  entry("walks to another robot", svg => draw_way(svg, [-15, 0], [20, 0]));
  entry("met another robot", svg => svg.append("path").attr("class", "star").attr("d", star_sign).style("fill", ink));
}
