// State chosen by the reader, and events on its changes.
//   visibility: visible robots              layers: drawn layers
//   highlight: one highlighted robot        moment: {robot, t} under the pointer, in the map or in a chart
//   colour: what colours the map's points   limits: height of points, and time, up to which they are shown
//   theme: light, dark or paper             structure: robots, frames and kinds of closures that there are

const changes = d3.dispatch("visibility", "layers", "highlight", "moment", "theme", "colour", "limits", "structure");
const few_robots = 8;
const many_closures = 10000;  // more would hide the trajectories and are off by default

const points_placed = report.access_points ? report.access_points.points.length : 0;
const many_points = 150;  // the same for access points

const state = {
  visible: robots.map(robot => robot.component === 0 && !robot.stranded),
  layers: { truth: true, odometry: robots.length <= few_robots, estimate: true, sigma: false, alternatives: true, grid: true, points: false, access_points: points_placed > 0 && points_placed <= many_points },
  groups: groups.map(group => group.status === "accepted" && group.count <= many_closures),
  highlight: null,
  moment: null,
  access_point: null,  // the selected one
  frame: 0,  // the component that was chosen
  axes: ["x", "y"],
};
if (!state.visible.some(v => v)) state.visible = robots.map(() => true);

const highlight = index => { if (state.highlight !== index) { state.highlight = index; changes.call("highlight"); } };
function point_at(moment) {
  if (state.moment === moment) return;
  state.moment = moment;
  changes.call("moment");
}
const fades = index => state.highlight !== null && state.highlight !== index;
const shown = () => robots.filter(robot => state.visible[robot.index]);

dark_scheme.addEventListener("change", () => changes.call("theme"));
window.addEventListener("beforeprint", () => { printing = true; changes.call("theme"); });
window.addEventListener("afterprint", () => { printing = false; changes.call("theme"); });

/// Calls `draw` once before the next frame, however often it is requested; immediately when printing.
function once_per_frame(draw) {
  let waiting = false;
  return () => {
    if (printing) return draw();
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; draw(); });
  };
}
