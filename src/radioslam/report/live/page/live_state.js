// What the agent knows, as its changes come (live_changes.hpp), in the columns that the report's scripts draw.

const step_m = 0.02, step_s = 0.01, step_rad = 0.01;
const column_steps = { t: step_s, x: step_m, y: step_m, z: step_m, heading: step_rad };
const line_columns = ["group", "robot_i", "keyframe_i", "robot_j", "keyframe_j"];

const live = { t: 0, rate: 1, clouds: [], team: [], peers: [], sent: [], known: [], sigmas: [], events: [] };

report.closures.reasons = groups;  // a line's reason is its group
lines.reason = lines.group;

/// Forgets everything, before the whole comes again.
function forget() {
  for (const list of [robots, groups, lines_at, report.components, state.visible, state.groups, live.clouds, live.known, live.sigmas, live.events]) list.length = 0;
  for (const key of line_columns) lines[key].length = 0;
  closures_total = closures_drawn = 0;
}

function add_robot(index) {
  robots[index] = { index, id: "", frame: "", component: 0, placed: true, stranded: false, keyframes: 0, walked_m: 0, estimate: null, odometry: null, truth: null };
  state.visible[index] = true;
  lines_at[index] = new Map();
}

/// The column with these differences from one value to the next, in steps, from an index on.
function changed_column(before, count, from, differences, step) {
  const values = new Float64Array(count);
  values.set(before.subarray(0, Math.min(count, before.length)));
  let at = from > 0 ? Math.round(values[from - 1] / step) : 0;
  differences.forEach((difference, k) => { values[from + k] = (at += difference) * step; });
  return values;
}

function path_length({ x, y, z }) {
  let sum = 0;
  for (let i = 1; i < x.length; ++i) sum += Math.hypot(x[i] - x[i - 1], y[i] - y[i - 1], z ? z[i] - z[i - 1] : 0);
  return sum;
}

function take_robot(change) {
  if (!robots[change.robot]) add_robot(change.robot);
  const robot = robots[change.robot], before = robot.estimate || {}, estimate = {};
  Object.assign(robot, { id: change.id, frame: change.frame, keyframes: change.count });
  for (const [key, step] of Object.entries(column_steps))
    if (change[key]) estimate[key] = changed_column(before[key] || new Float64Array(0), change.count, change.from, change[key], step);
  robot.estimate = change.count ? estimate : null;
  robot.walked_m = robot.estimate ? path_length(estimate) : 0;
  if (estimate.z) report.dimension = 3;
}

/// Frames in the order of their first robots, that of this agent's robot in front.
function take_frames() {
  const names = [...new Set([...robots.filter(robot => robot.id === report.self), ...robots].map(robot => robot.frame))];
  for (const robot of robots) robot.component = names.indexOf(robot.frame);
  report.components.splice(0, Infinity, ...names.map(name => robots.filter(robot => robot.frame === name).map(robot => robot.id)));
}

function take_lines(change) {
  const key = group => `${group.kind} ${group.status}`;
  const chosen = new Map(groups.map((group, g) => [key(group), state.groups[g]]));
  groups.splice(0, Infinity, ...change.groups);
  state.groups.splice(0, Infinity, ...groups.map(group => (chosen.has(key(group)) ? chosen.get(key(group)) : group.status === "accepted")));
  for (const name of line_columns) {
    lines[name].length = change.from;
    for (const value of change[name]) lines[name].push(value);
  }
  closures_total = total(groups, group => group.count);
  closures_drawn = lines.group.length;
  lines_at.forEach(at => at.clear());
  lines.group.forEach((_, c) => {
    for (const [robot, keyframe] of [[lines.robot_i[c], lines.keyframe_i[c]], [lines.robot_j[c], lines.keyframe_j[c]]]) {
      const at = lines_at[robot];
      if (at.has(keyframe)) at.get(keyframe).push(c);
      else at.set(keyframe, [c]);
    }
  });
}

/// The points of all scans where their keyframes are now.
function place_points(has_more) {
  const count = total(live.clouds, scan => scan.x.length);
  const points = { count, x: new Float32Array(count), y: new Float32Array(count), z: new Float32Array(count), t: new Float32Array(count), robot: new Uint8Array(count) };
  let end = 0;
  for (const scan of live.clouds) {
    const path = robots[scan.robot].estimate;
    if (!path) continue;
    const i = nearest_index(path.t, scan.t * step_s), c = step_m * Math.cos(path.heading[i]), s = step_m * Math.sin(path.heading[i]);
    for (let k = 0; k < scan.x.length; ++k, ++end) {
      points.x[end] = path.x[i] + c * scan.x[k] - s * scan.y[k];
      points.y[end] = path.y[i] + s * scan.x[k] + c * scan.y[k];
      points.z[end] = (path.z ? path.z[i] : 0) + step_m * scan.z[k];
      points.t[end] = path.t[i];
      points.robot[end] = scan.robot;
    }
  }
  points.count = end;
  cloud = points;
  colours_now = null;
  if (has_more && end) {
    height_span = span_of(cloud.z.subarray(0, end));
    has_heights = height_span[1] - height_span[0] > 0.2;
  }
}

const structure = () => JSON.stringify([report.components, groups, cloud.count > 0]);

/// Takes a change; what of the page is another one now.
function take_change(change) {
  const before = structure(), frames = JSON.stringify(report.components), had_points = cloud.count > 0;
  if (change.whole) forget();
  Object.assign(live, { t: change.t, rate: change.rate, team: change.team, peers: change.peers, sent: change.sent });
  change.robots.forEach(take_robot);
  take_frames();
  if (change.lines) take_lines(change.lines);
  for (const key of ["clouds", "known", "sigmas", "events"]) live[key].push(...change[key]);
  if (live.clouds.length && (change.robots.length || change.clouds.length)) place_points(change.clouds.length > 0);
  if (!had_points && cloud.count) state.layers.points = true;
  time_end = live.t;
  if (JSON.stringify(report.components) !== frames) {
    state.frame = 0;
    state.visible.splice(0, Infinity, ...robots.map(robot => robot.component === 0));
  }
  teams.clear();
  return { is_moved: change.robots.length > 0 || change.clouds.length > 0 || Boolean(change.lines), is_rebuilt: structure() !== before };
}
