// Data of the run as the page uses them: typed columns and a few sums.

const report = JSON.parse(document.getElementById("data").textContent);

const column = values => Float64Array.from(values || [], v => (v === null ? NaN : v));

function columns(path) {
  if (!path || path.t.length === 0) return null;
  const named = {};
  for (const key of Object.keys(path)) named[key] = column(path[key]);
  return named;
}

const robots = report.robots.map((robot, index) => ({
  ...robot,
  index,
  estimate: columns(robot.estimate),
  odometry: columns(robot.odometry),
  truth: columns(robot.truth),
  sigma_m: robot.sigma_m ? column(robot.sigma_m) : null,
  sigma_team_m: robot.sigma_team_m ? column(robot.sigma_team_m) : null,
  errors: columns(robot.errors),
  dead_reckoning_errors: columns(robot.dead_reckoning_errors),
  stranded: !robot.placed || report.unplaced.includes(robot.id),
}));

const alternatives = report.alternatives.map(other => ({
  ...other,
  robots: other.robots.map(path => (path.x.length ? { x: column(path.x), y: column(path.y), z: path.z && column(path.z) } : null)),
}));

const groups = report.closures.groups;
const lines = report.closures.drawn;
const total = (items, value) => items.reduce((sum, item) => sum + value(item), 0);
let closures_total = total(groups, g => g.count);
let closures_drawn = total(groups, g => g.drawn);
const accepted_total = total(groups.filter(g => g.status === "accepted"), g => g.count);
const seconds_total = total(report.timings, t => t.seconds);

// The lines that end at each keyframe, for the one under the pointer.
const lines_at = robots.map(() => new Map());
for (let c = 0; c < lines.group.length; ++c)
  for (const [robot, keyframe] of [[lines.robot_i[c], lines.keyframe_i[c]], [lines.robot_j[c], lines.keyframe_j[c]]]) {
    const at = lines_at[robot];
    if (at.has(keyframe)) at.get(keyframe).push(c);
    else at.set(keyframe, [c]);
  }
