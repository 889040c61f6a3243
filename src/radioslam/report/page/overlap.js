// Pairs kept by the overlap search: a matrix per pair of robots, keyframes of one horizontally, of the other vertically.

const dot = { accepted: 2.6, rejected: 1.8, link: 2.4 };

/// Number of the n keyframes in a bin.
const bin_size = (bin, bins, n) => Math.ceil(((bin + 1) * n) / bins) - Math.ceil((bin * n) / bins);

function draw_kept(context, matrix, side) {
  // Edges are on whole pixels; otherwise seams between cells would be visible as a grid.
  const across = i => Math.round((i * side) / matrix.bins_i), up = j => side - Math.round((j * side) / matrix.bins_j);
  const n_i = robots[matrix.robot_i].keyframes, n_j = robots[matrix.robot_j].keyframes;
  context.fillStyle = css("accent");
  matrix.cell.forEach((cell, k) => {
    const i = cell % matrix.bins_i, j = Math.floor(cell / matrix.bins_i);
    const share = matrix.count[k] / (bin_size(i, matrix.bins_i, n_i) * bin_size(j, matrix.bins_j, n_j));
    context.globalAlpha = 0.15 + 0.4 * Math.min(1, share);
    context.fillRect(across(i), up(j + 1), across(i + 1) - across(i), up(j) - up(j + 1));
  });
  context.globalAlpha = 1;
}

/// Position of a drawn closure in the matrix, as ratios of both trajectories; null if it belongs to other robots.
function place_in(matrix, c) {
  const share = (robot, keyframe) => (keyframe + 0.5) / robots[robot].estimate.t.length;
  const i = lines.robot_i[c], j = lines.robot_j[c];
  if (i === matrix.robot_i && j === matrix.robot_j) return [share(i, lines.keyframe_i[c]), share(j, lines.keyframe_j[c])];
  if (j === matrix.robot_i && i === matrix.robot_j) return [share(j, lines.keyframe_j[c]), share(i, lines.keyframe_i[c])];
  return null;
}

const is_link = group => group.kind === "range" || group.kind === "aoa";
const is_place = group => !is_link(group) && group.kind !== "fingerprint";

function draw_closures_in(context, matrix, side) {
  for (let c = 0; c < lines.group.length; ++c) {
    const group = groups[lines.group[c]], at = is_link(group) || is_place(group) ? place_in(matrix, c) : null;
    if (!at) continue;
    context.beginPath();
    context.arc(at[0] * side, side - at[1] * side, is_link(group) ? dot.link : dot[group.status], 0, 2 * Math.PI);
    context.fillStyle = context.strokeStyle = closure_colour(group);
    if (is_link(group)) context.stroke();
    else context.fill();
  }
}

function draw_matrix(canvas, matrix) {
  const side = canvas.clientWidth, ratio = window.devicePixelRatio || 1;
  if (!side) return;
  canvas.width = canvas.height = Math.round(side * ratio);
  const context = canvas.getContext("2d");
  draw_kept(context, matrix, canvas.width);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  draw_closures_in(context, matrix, side);
}

function matrix_figure(matrix, index) {
  const i = robots[matrix.robot_i], j = robots[matrix.robot_j], pairs = i.keyframes * j.keyframes;
  const share = format.fine_percent(matrix.kept / pairs), text = `${format.count(matrix.kept)} of ${format.count(pairs)} pairs, ${share}`;
  const canvas = element("canvas", { role: "img", "aria-label": `Kept pairs of ${i.id} and ${j.id}: ${text}` });
  const redraw = once_per_frame(() => draw_matrix(canvas, matrix));
  new ResizeObserver(redraw).observe(canvas);
  changes.on(`theme.matrix${index}`, redraw);
  return element("div", { class: "matrix" }, element("p", {}, element("b", {}, `${shortened(i.id)} × ${shortened(j.id)}`), ` ${format.count(matrix.kept)} kept, ${share}`), canvas,
    element("div", { class: "across" }, element("span", {}, `horizontal: keyframes of ${shortened(i.id)}`), element("span", {}, `vertical: keyframes of ${shortened(j.id)}`)));
}

function key_of_overlap() {
  const mark = (text, draw) => {
    const svg = d3.create("svg").attr("viewBox", "0 0 26 10").attr("aria-hidden", "true");
    draw(svg);
    return element("span", { class: "key" }, svg.node(), text);
  };
  const round = (svg, group) => svg.append("circle").attr("cx", 13).attr("cy", 5).attr("r", 3)
    .attr("fill", is_link(group) ? "none" : closure_colour(group)).attr("stroke", closure_colour(group));
  return [mark("kept: not excluded by the estimate", svg => svg.append("rect").attr("width", 26).attr("height", 10).attr("fill", css("accent")).attr("opacity", 0.55)),
    ...groups.filter(g => is_link(g) || is_place(g)).map(g => mark(`${g.kind}, ${g.status}`, svg => round(svg, g)))];
}

function write_overlap() {
  const { matrices, robot_pairs, kept, listed, pairs, distances_evaluated } = report.candidates;
  if (!known(pairs) && !matrices.length) return;
  show("overlap-section");
  const key = () => by_id("overlap-key").replaceChildren(...key_of_overlap());
  key();
  changes.on("theme.overlap", key);
  by_id("overlap-matrices").append(...matrices.map(matrix_figure));
  const of_robots = (robots.length * (robots.length - 1)) / 2;
  const parts = [`${format.count(kept)} of ${format.count(pairs)} keyframe pairs remain for place recognition; the search evaluated ${format.count(distances_evaluated)} distances.`];
  if (listed < kept) parts.push(`Only the ${format.count(listed)} most probable, which candidates.csv lists, are drawn and counted below.`);
  if (robot_pairs < of_robots) parts.push(`${format.count(of_robots - robot_pairs)} of ${format.count(of_robots)} pairs of robots have none${listed < kept ? " of these" : ""}.`);
  if (matrices.length < robot_pairs) parts.push(`The ${matrices.length} with the most pairs, of ${format.count(robot_pairs)}, are shown.`);
  if (matrices.length) parts.push("The darker a cell, the more of its pairs were kept.");
  by_id("overlap-caption").textContent = parts.join(" ");
}
