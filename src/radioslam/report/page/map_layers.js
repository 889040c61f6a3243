// Layers of the map, from bottom to top. A view maps metres to pixels: px = view.ox + view.k x, py = view.oy - view.k y.

const moving_lines = 4000;    // closures drawn while the view moves
const moving_points = 30000;  // poses above which a moving view is drawn more coarsely
const lines_per_path = 400;   // a browser's stroke of n crossing lines costs more than n strokes of one
const points_per_path = 200;

/// Strokes a path in the plane, without points that coincide with the last one and segments outside the view.
function stroke_path(context, xs, ys, view) {
  const { k, ox, oy, width, height } = view, least = view.moving && view.points > moving_points ? 3 : 0.7;
  let last_x = 0, last_y = 0, last_side = 0, begun = false, points = 0;
  context.beginPath();
  for (let i = 0; i < xs.length; ++i) {
    const px = ox + k * xs[i], py = oy - k * ys[i];
    if (!(isFinite(px) && isFinite(py))) { begun = false; continue; }
    if (begun && i + 1 < xs.length && Math.abs(px - last_x) < least && Math.abs(py - last_y) < least) continue;
    if (++points % points_per_path === 0) {
      context.stroke();
      context.beginPath();
      context.moveTo(last_x, last_y);
    }
    const side = (px < 0 ? 1 : px > width ? 2 : 0) | (py < 0 ? 4 : py > height ? 8 : 0);
    if (begun && !(side & last_side)) context.lineTo(px, py);
    else context.moveTo(px, py);
    begun = true;
    last_x = px;
    last_y = py;
    last_side = side;
  }
  context.stroke();
}

function draw_grid(context, view) {
  const step = d3.tickStep(0, 110 / view.k, 1);
  const west = -view.ox / view.k, east = (view.width - view.ox) / view.k;
  const south = (view.oy - view.height) / view.k, north = view.oy / view.k;
  context.strokeStyle = css("grid");
  context.lineWidth = 1;
  context.beginPath();
  for (let i = Math.ceil(west / step); i * step <= east; ++i) {
    const px = Math.round(view.ox + view.k * i * step) + 0.5;
    context.moveTo(px, 0);
    context.lineTo(px, view.height);
  }
  for (let i = Math.ceil(south / step); i * step <= north; ++i) {
    const py = Math.round(view.oy - view.k * i * step) + 0.5;
    context.moveTo(0, py);
    context.lineTo(view.width, py);
  }
  context.stroke();
}

/// Estimates are those of the chosen hypothesis.
const path_of = (robot, layer) => (layer === "estimate" ? chosen_team().paths[robot.index] : robot[layer]);

function draw_paths(context, view, layer, style) {
  const [a, b] = state.axes;
  context.lineJoin = "round";
  context.setLineDash(style.dash && !(view.moving && view.points > moving_points) ? style.dash : []);
  for (const robot of shown()) {
    const path = path_of(robot, layer);
    if (!path) continue;
    context.globalAlpha = fades(robot.index) ? 0.12 : style.alpha;
    context.strokeStyle = style.colour(robot.index);
    context.lineWidth = style.width + (state.highlight === robot.index ? 1 : 0);
    const until = isFinite(state.until) ? d3.bisectRight(path.t, state.until) : undefined;
    stroke_path(context, path[a].subarray(0, until), path[b].subarray(0, until), view);
  }
  context.setLineDash([]);
  context.globalAlpha = 1;
}

/// The other hypotheses, more opaque if more likely; dotted, whereas odometry is dashed.
function draw_alternatives(context, view) {
  const [a, b] = state.axes;
  context.setLineDash(view.moving ? [] : [1, 3]);
  context.lineCap = "round";
  context.lineWidth = 1.6;
  alternatives.forEach(other => {
    for (const robot of shown()) {
      const path = other.robots[robot.index];
      if (!path) continue;
      context.globalAlpha = fades(robot.index) ? 0.1 : 0.5 + 0.4 * Math.min(1, other.weight / report.weight);
      context.strokeStyle = robot_colour(robot.index);
      stroke_path(context, path[a], path[b], view);
    }
  });
  context.setLineDash([]);
  context.lineCap = "butt";
  context.globalAlpha = 1;
}

/// One filled area per robot: the union of discs of one sigma, in the gauge of the team, about its keyframes.
function draw_sigma(context, view) {
  const [a, b] = state.axes;
  context.globalAlpha = 0.16;
  for (const robot of shown()) {
    if (!robot.sigma_team_m || !robot.estimate || fades(robot.index)) continue;
    const xs = robot.estimate[a], ys = robot.estimate[b];
    let last_x = NaN, last_y = NaN;
    context.fillStyle = robot_colour(robot.index);
    context.beginPath();
    for (let i = 0; i < xs.length; ++i) {
      const px = view.ox + view.k * xs[i], py = view.oy - view.k * ys[i], radius = view.k * robot.sigma_team_m[i];
      if (!isFinite(radius) || Math.hypot(px - last_x, py - last_y) < Math.max(2, radius / 4)) continue;
      context.moveTo(px + radius, py);
      context.arc(px, py, radius, 0, 2 * Math.PI);
      last_x = px;
      last_y = py;
    }
    context.fill();
  }
  context.globalAlpha = 1;
}

function line_ends(c, view) {
  const [a, b] = state.axes;
  const from = robots[lines.robot_i[c]].estimate, to = robots[lines.robot_j[c]].estimate;
  const i = lines.keyframe_i[c], j = lines.keyframe_j[c];
  return [view.ox + view.k * from[a][i], view.oy - view.k * from[b][i], view.ox + view.k * to[a][j], view.oy - view.k * to[b][j]];
}

const line_time = c => Math.max(robots[lines.robot_i[c]].estimate.t[lines.keyframe_i[c]], robots[lines.robot_j[c]].estimate.t[lines.keyframe_j[c]]);
const line_shown = c => is_shown_team() && state.groups[lines.group[c]] && state.visible[lines.robot_i[c]] && state.visible[lines.robot_j[c]]
  && (state.until === Infinity || line_time(c) <= state.until);
const line_fades = c => state.highlight !== null && fades(lines.robot_i[c]) && fades(lines.robot_j[c]);

function draw_closures(context, view) {
  const stride = view.moving ? Math.ceil(lines.group.length / moving_lines) : 1;
  const alpha = Math.max(0.1, Math.min(0.6, 14 / Math.sqrt(1 + closures_drawn / stride)));
  const open = groups.map(() => 0);
  const paths = groups.map(() => null);
  context.lineWidth = 1;
  const stroke = g => {
    context.strokeStyle = closure_colour(groups[g]);
    context.globalAlpha = alpha;
    context.stroke(paths[g]);
    paths[g] = null;
    open[g] = 0;
  };
  for (let c = 0; c < lines.group.length; c += stride) {
    const g = lines.group[c];
    if (!line_shown(c) || line_fades(c)) continue;
    const [ax, ay, bx, by] = line_ends(c, view);
    paths[g] = paths[g] || new Path2D();
    paths[g].moveTo(ax, ay);
    paths[g].lineTo(bx, by);
    if (++open[g] === lines_per_path) stroke(g);
  }
  groups.forEach((_, g) => paths[g] && stroke(g));
  context.globalAlpha = 1;
}

function draw_starts(context, view) {
  const [a, b] = state.axes;
  for (const robot of shown()) {
    const path = path_of(robot, "estimate");
    if (!path || fades(robot.index) || (robots.length > few_robots && state.highlight !== robot.index)) continue;
    context.beginPath();
    context.arc(view.ox + view.k * path[a][0], view.oy - view.k * path[b][0], 4, 0, 2 * Math.PI);
    context.fillStyle = css("paper");
    context.strokeStyle = robot_colour(robot.index);
    context.lineWidth = 2;
    context.fill();
    context.stroke();
  }
}

const nearest_index = (times, t) => {
  const after = d3.bisectLeft(times, t);
  return after > 0 && (after === times.length || t - times[after - 1] < times[after] - t) ? after - 1 : after;
};

/// The keyframe under the pointer, with its closures and its distance from the truth.
function draw_moment(context, view) {
  const { robot: index, t } = state.moment, robot = robots[index], [a, b] = state.axes, path = path_of(robot, "estimate");
  if (!path || !state.visible[index]) return;
  const i = nearest_index(path.t, t);
  const px = view.ox + view.k * path[a][i], py = view.oy - view.k * path[b][i];
  context.lineWidth = 2;
  for (const c of lines_at[index].get(i) || []) {
    if (!line_shown(c)) continue;
    const [ax, ay, bx, by] = line_ends(c, view);
    context.strokeStyle = closure_colour(groups[lines.group[c]]);
    context.beginPath();
    context.moveTo(ax, ay);
    context.lineTo(bx, by);
    context.stroke();
  }
  context.strokeStyle = css("ink");
  context.lineWidth = 1.5;
  context.beginPath();
  if (state.layers.truth && robot.truth) {
    const at = nearest_index(robot.truth.t, robot.estimate.t[i]);
    context.moveTo(px, py);
    context.lineTo(view.ox + view.k * robot.truth[a][at], view.oy - view.k * robot.truth[b][at]);
  }
  context.stroke();
  context.fillStyle = robot_colour(index);
  context.beginPath();
  context.arc(px, py, 5, 0, 2 * Math.PI);
  context.fill();
  context.stroke();
}

function draw_scale_bar(context, view) {
  const metres = d3.tickStep(0, 130 / view.k, 1), length = metres * view.k;
  const left = 16, bottom = view.height - 16;
  const text = metres >= 1000 ? `${metres / 1000} km` : metres >= 0.01 ? `${metres} m` : `${metres * 1000} mm`;
  context.fillStyle = css("paper");
  context.globalAlpha = 0.8;
  context.fillRect(left - 6, bottom - 24, Math.max(length, 40) + 12, 30);
  context.globalAlpha = 1;
  context.strokeStyle = context.fillStyle = css("ink");
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(left, bottom - 5);
  context.lineTo(left, bottom);
  context.lineTo(left + length, bottom);
  context.lineTo(left + length, bottom - 5);
  context.stroke();
  context.font = "12px system-ui, sans-serif";
  context.fillText(text, left, bottom - 10);
}

const more_layers = [];  // of a page that has more, drawn on top

function draw_map(context, view) {
  context.clearRect(0, 0, view.width, view.height);
  draw_grid(context, view);
  const many = robots.length > few_robots, { layers } = state;
  if (layers.grid) draw_grids(context, view);
  if (layers.points) draw_points(context, view);
  if (layers.sigma && is_shown_team()) draw_sigma(context, view);
  if (layers.truth) draw_paths(context, view, "truth", { colour: () => css("truth"), width: many ? 2 : 3.5, alpha: 0.75 });
  if (layers.odometry) draw_paths(context, view, "odometry", { colour: robot_colour, width: 1.1, alpha: 0.75, dash: [5, 4] });
  if (layers.alternatives) draw_alternatives(context, view);
  draw_closures(context, view);
  if (layers.estimate) draw_paths(context, view, "estimate", { colour: robot_colour, width: many ? 1.2 : 1.8, alpha: 1 });
  if (layers.estimate) draw_starts(context, view);
  if (layers.access_points) draw_access_points(context, view);
  for (const draw of more_layers) draw(context, view);
  draw_scale_bar(context, view);
}
