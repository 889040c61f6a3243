// Maps of the team: occupancy grids under the trajectories, and points by robot, height or time. The sliders limit
// the points by height, and everything by time.

const has_grid = report.maps.some(map => map.grid);
let time_end = d3.max(robots, robot => (robot.estimate ? robot.estimate.t[robot.estimate.t.length - 1] : 0)) || 0;

/// Points of all maps as columns; robot: index in the page.
let cloud = unpack_points(report.maps.filter(map => map.points));

function unpack_points(maps) {
  const count = total(maps, map => map.points.count);
  const points = { count, x: new Float32Array(count), y: new Float32Array(count), z: new Float32Array(count), t: new Float32Array(count), robot: new Uint8Array(count) };
  let begin = 0;
  for (const { points: { count: n, low, high, data }, robots: ids } of maps) {
    const bytes = Uint8Array.from(atob(data), c => c.charCodeAt(0)), view = new DataView(bytes.buffer);
    [points.x, points.y, points.z, points.t].forEach((column, axis) => {
      const step = (high[axis] - low[axis]) / 65535;
      for (let k = 0; k < n; ++k) column[begin + k] = low[axis] + step * view.getUint16(2 * (axis * n + k), true);
    });
    for (let k = 0; k < n; ++k) points.robot[begin + k] = ids[bytes[8 * n + k]];
    begin += n;
  }
  return points;
}

const span_of = values => (values.length ? [0.005, 0.995].map(q => d3.quantile(Float32Array.from(values.filter((_, k) => k % Math.ceil(values.length / 20000) === 0)).sort(), q)) : [0, 1]);
let height_span = span_of(cloud.z);
let has_heights = cloud.count > 0 && height_span[1] - height_span[0] > 0.2;
state.top = Infinity;    // height up to which points are shown
state.until = Infinity;  // time up to which points, trajectories and closures are shown
state.colour = "robot";

state.hypothesis = "shown";  // the team whose points are drawn: this, or the index of an alternative

/// The plane motion of a robot from the team that is shown to another, by least squares over its path.
function motion_to(other, robot) {
  const from = robots[robot].estimate, to = other.robots[robot], samples = 50;
  if (!from || !to) return null;
  const at = (values, share) => values[Math.round(share * (values.length - 1))];
  const shares = d3.range(samples).map(k => k / (samples - 1)), mean = (path, axis) => d3.mean(shares, s => (path[axis] ? at(path[axis], s) : 0));
  const [fx, fy, fz, tx, ty, tz] = [from, to].flatMap(path => ["x", "y", "z"].map(axis => mean(path, axis)));
  let dot = 0, cross = 0;
  for (const s of shares) {
    const [u, v, p, q] = [at(from.x, s) - fx, at(from.y, s) - fy, at(to.x, s) - tx, at(to.y, s) - ty];
    dot += u * p + v * q;
    cross += u * q - v * p;
  }
  const yaw = Math.atan2(cross, dot), c = Math.cos(yaw), s = Math.sin(yaw);
  return (x, y, z) => [tx + c * (x - fx) - s * (y - fy), ty + s * (x - fx) + c * (y - fy), z + (from.z && to.z ? tz - fz : 0)];
}

/// The points and trajectories as the chosen hypothesis places each robot; the grids are those of the team shown.
const teams = new Map();
function chosen_team() {
  if (!teams.has(state.hypothesis)) teams.set(state.hypothesis, state.hypothesis === "shown" ? { cloud, paths: robots.map(r => r.estimate) } : moved_team());
  return teams.get(state.hypothesis);
}
const is_shown_team = () => state.hypothesis === "shown";

function moved_team() {
  const motions = robots.map(robot => motion_to(alternatives[state.hypothesis], robot.index));
  const moved = (columns, motion_of) => {
    const result = { ...columns, x: columns.x.slice(), y: columns.y.slice() };
    if (columns.z) result.z = columns.z.slice();
    for (let k = 0; k < columns.x.length; ++k) {
      const motion = motion_of(k);
      if (!motion) continue;
      const [x, y, z] = motion(columns.x[k], columns.y[k], columns.z ? columns.z[k] : 0);
      result.x[k] = x;
      result.y[k] = y;
      if (columns.z) result.z[k] = z;
    }
    return result;
  };
  return { cloud: moved(cloud, k => motions[cloud.robot[k]]), paths: robots.map((robot, r) => (robot.estimate ? moved(robot.estimate, () => motions[r]) : null)) };
}

/// Colours of all points as [r, g, b, a]; hidden robots have a = 0.
function point_colours() {
  const colours = new Uint8Array(4 * cloud.count), of_robot = robots.map(robot => d3.rgb(robot_colour(robot.index)));
  const ramp = d3.range(256).map(k => d3.rgb(d3.interpolateViridis(is_dark() ? 0.15 + (0.85 * k) / 255 : (0.92 * k) / 255)));
  const values = state.colour === "height" ? cloud.z : cloud.t, [low, high] = state.colour === "height" ? height_span : [0, time_end];
  for (let k = 0; k < cloud.count; ++k) {
    const c = state.colour === "robot" ? of_robot[cloud.robot[k]]
      : ramp[Math.max(0, Math.min(255, Math.round((255 * (values[k] - low)) / (high - low || 1))))];
    colours[4 * k] = c.r;
    colours[4 * k + 1] = c.g;
    colours[4 * k + 2] = c.b;
    colours[4 * k + 3] = state.visible[cloud.robot[k]] ? 255 : 0;
  }
  return colours;
}

let colours_now = null;
for (const change of ["visibility", "theme", "colour"]) changes.on(`${change}.points`, () => { colours_now = null; });
const current_colours = () => colours_now || (colours_now = point_colours());

/// The grids as images, one pixel per cell; drawn again when the theme changes.
let grid_images = null;
changes.on("theme.grid", () => { grid_images = null; });

function grid_image({ width, height, runs }) {
  const canvas = element("canvas", { width, height }), context = canvas.getContext("2d"), image = context.createImageData(width, height);
  const free = d3.rgb(css("free")), wall = d3.rgb(css("walls")), colours = [null, free, wall];
  let cell = 0;
  runs.forEach((length, run) => {
    const colour = colours[run % 3];
    for (const end = cell + length; cell < end; ++cell) {
      if (!colour) continue;
      const at = 4 * ((height - 1 - Math.floor(cell / width)) * width + (cell % width));
      image.data.set([colour.r, colour.g, colour.b, 255], at);
    }
  });
  context.putImageData(image, 0, 0);
  return canvas;
}

const from_above = () => state.axes[0] === "x" && state.axes[1] === "y";
const map_shown = map => map.robots.some(robot => state.visible[robot]);

function draw_grids(context, view) {
  if (!from_above() || !is_shown_team()) return;
  grid_images = grid_images || report.maps.map(map => (map.grid ? grid_image(map.grid) : null));
  report.maps.forEach((map, m) => {
    if (!map.grid || !map_shown(map)) return;
    const { cell_m, width, height, x0, y0, x, y, yaw } = map.grid;
    context.save();
    context.translate(view.ox + view.k * x, view.oy - view.k * y);
    context.rotate(-yaw);
    context.imageSmoothingEnabled = view.k * cell_m < 1;
    context.drawImage(grid_images[m], view.k * x0, -view.k * (y0 + height * cell_m), view.k * width * cell_m, view.k * height * cell_m);
    context.restore();
  });
}

/// Corners of the grids in the page's frame, for the view that shows everything.
function grid_corners(axis) {
  const of = ({ cell_m, width, height, x0, y0, x, y, yaw }) => [[0, 0], [1, 0], [0, 1], [1, 1]].map(([i, j]) => {
    const u = x0 + i * width * cell_m, v = y0 + j * height * cell_m;
    return axis === "x" ? x + Math.cos(yaw) * u - Math.sin(yaw) * v : y + Math.sin(yaw) * u + Math.cos(yaw) * v;
  });
  return report.maps.filter(map => map.grid && map_shown(map)).flatMap(map => of(map.grid));
}

let point_canvas = null;

/// A pixel or more per point, written straight into an image.
function draw_points(context, view) {
  if (!cloud.count) return;
  point_canvas = point_canvas || document.createElement("canvas");
  const ratio = view.ratio, width = Math.round(view.width * ratio), height = Math.round(view.height * ratio);
  if (point_canvas.width !== width || point_canvas.height !== height) Object.assign(point_canvas, { width, height });
  const layer = point_canvas.getContext("2d"), image = layer.createImageData(width, height);
  const out = new Uint32Array(image.data.buffer), colours = new Uint32Array(current_colours().buffer);
  const placed = chosen_team().cloud, a = placed[state.axes[0]], b = placed[state.axes[1]], k = view.k * ratio, ox = view.ox * ratio, oy = view.oy * ratio;
  const side = Math.max(1, Math.min(4, Math.round(0.05 * k)));
  for (let n = 0; n < cloud.count; ++n) {
    if (cloud.z[n] > state.top || cloud.t[n] > state.until || !(colours[n] >>> 24)) continue;
    const px = Math.floor(ox + k * a[n]), py = Math.floor(oy - k * b[n]);
    if (px < 0 || py < 0 || px + side > width || py + side > height) continue;
    for (let y = py; y < py + side; ++y) for (let x = px; x < px + side; ++x) out[y * width + x] = colours[n];
  }
  layer.putImageData(image, 0, 0);
  context.drawImage(point_canvas, 0, 0, view.width, view.height);
}
