// The map as it grows: shows everything until the reader has zoomed or moved it.

let map = null;

/// Where each robot is now, and where it looks.
function draw_robots(context, view) {
  const [a, b] = state.axes, size = 9;
  for (const robot of shown()) {
    const path = path_of(robot, "estimate");
    if (!path || fades(robot.index)) continue;
    const i = path.t.length - 1, angle = path.heading && from_above() ? -path.heading[i] : 0;
    context.save();
    context.translate(view.ox + view.k * path[a][i], view.oy - view.k * path[b][i]);
    context.rotate(angle);
    context.beginPath();
    if (from_above()) [[size, 0], [-0.7 * size, 0.65 * size], [-0.35 * size, 0], [-0.7 * size, -0.65 * size]].forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
    else context.arc(0, 0, 0.6 * size, 0, 2 * Math.PI);
    context.closePath();
    context.fillStyle = robot_colour(robot.index);
    context.strokeStyle = css("paper");
    context.lineWidth = 1.5;
    context.stroke();
    context.fill();
    context.restore();
  }
}
more_layers.push(draw_robots);

function caption_live_map() {
  const parts = ["A ring marks a robot's start, an arrow where it is now."];
  if (report.components.length > 1) parts.push(`The team has ${report.components.length} frames; nothing that is certain connects them.`);
  if (closures_drawn < closures_total) parts.push(`${format.count(closures_drawn)} of ${format.count(closures_total)} closures and links are drawn.`);
  if (cloud.count) parts.push(`${format.count(cloud.count)} points of ${format.plural(live.clouds.length, "scan")}, thinned.`);
  by_id("map-caption").textContent = parts.join(" ");
}

function update_map({ is_moved, is_rebuilt }) {
  if (!map) {
    if (!robots.some(robot => robot.estimate)) return;
    show("map-section");
    map = new MapView(by_id("map-canvas"));
    draw_panel(by_id("map-panel"), map);
  } else if (is_rebuilt && !by_id("map-panel").contains(document.activeElement)) {
    changes.call("structure");
  }
  caption_live_map();
  if (!is_moved) return;
  map.tree = null;
  const { k, x, y } = map.transform;
  if (map.width && k === 1 && x === 0 && y === 0) map.measure();
  changes.call("layers");
}
