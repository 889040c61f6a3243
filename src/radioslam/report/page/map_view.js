// The map: size, zoom, pointer and keys. Both axes have the same scale.

const scale_bar_px = 44;  // at the bottom, kept free when everything is shown
const described_closures = 6;  // in the tooltip of a keyframe

class MapView {
  constructor(parent) {
    this.parent = parent;
    this.canvas = element("canvas", { tabindex: "0", role: "img", "aria-label": map_description() });
    this.overlay = element("canvas", { class: "overlay", "aria-hidden": "true" });
    this.tooltip = element("div", { class: "tooltip", hidden: true });
    this.hint = element("span", { class: "hint" }, "Click, then scroll to zoom");
    parent.append(this.canvas, this.overlay, this.hint, this.buttons(), this.tooltip);
    this.context = this.canvas.getContext("2d");
    this.transform = d3.zoomIdentity;
    this.redraw = once_per_frame(() => this.draw());
    this.redraw_moment = once_per_frame(() => this.draw_moment());
    this.zoom = d3.zoom().scaleExtent([0.2, 400]).filter(() => this.accepts(d3.event))
      .on("zoom", () => this.moved(d3.event.transform));
    d3.select(this.canvas).call(this.zoom).on("dblclick.zoom", null).on("dblclick", () => this.fit());
    this.listen();
    new ResizeObserver(() => this.resize()).observe(parent);
  }

  /// Shows the map in space, or in the plane again.
  set_space(on) {
    if (on && !this.space) this.space = new SpaceView(this.parent);
    this.in_space = on;
    for (const part of [this.canvas, this.overlay]) part.hidden = on;
    if (this.space) this.space.canvas.hidden = !on;
    this.leave();
    this.fit();
  }

  buttons() {
    const button = (text, label, action) => element("button", { type: "button", "aria-label": label, title: label, onclick: action }, text);
    return element("div", { class: "map-buttons" }, button("+", "Zoom in", () => this.zoom_by(1.6)),
      button("−", "Zoom out", () => this.zoom_by(1 / 1.6)), button("Fit", "Show everything", () => this.fit()));
  }

  listen() {
    changes.on("visibility.map", () => { this.tree = null; this.redraw(); });
    for (const change of ["layers", "highlight", "theme", "colour", "limits"]) changes.on(`${change}.map`, this.redraw);
    changes.on("moment.map", this.redraw_moment);
    this.canvas.addEventListener("mousemove", event => this.point(event));
    this.canvas.addEventListener("mouseleave", () => this.leave());
    this.canvas.addEventListener("focus", () => { this.hint.hidden = true; });
    this.canvas.addEventListener("blur", () => { this.hint.hidden = false; });
    this.canvas.addEventListener("keydown", event => this.key(event));
  }

  /// The wheel zooms only after the map has been clicked, so that it does not interfere with scrolling; one finger
  /// scrolls the page, two move the map.
  accepts(event) {
    if (event.type === "wheel") return event.ctrlKey || document.activeElement === this.canvas;
    if (event.touches) return event.touches.length > 1;
    return !event.button;
  }

  key(event) {
    const step = 60, pan = { ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key];
    if (pan) d3.select(this.canvas).call(this.zoom.translateBy, pan[0] / this.transform.k, pan[1] / this.transform.k);
    else if (event.key === "+" || event.key === "=") this.zoom_by(1.6);
    else if (event.key === "-") this.zoom_by(1 / 1.6);
    else if (event.key === "0") this.fit();
    else return;
    event.preventDefault();
  }

  zoom_by(factor) { if (this.in_space) this.space.zoom_by(factor); else d3.select(this.canvas).call(this.zoom.scaleBy, factor); }

  fit() {
    if (this.in_space) return this.space.fit();
    this.measure();
    d3.select(this.canvas).call(this.zoom.transform, d3.zoomIdentity);
    this.redraw();
  }

  moved(transform) {
    this.transform = transform;
    this.moving = true;
    clearTimeout(this.rest);
    this.rest = setTimeout(() => { this.moving = false; this.redraw(); }, 160);
    this.redraw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.parent;
    if (!width || !height) return;
    const ratio = window.devicePixelRatio || 1;
    Object.assign(this, { width, height, ratio });
    for (const canvas of [this.canvas, this.overlay]) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
      Object.assign(canvas.style, { width: `${width}px`, height: `${height}px` });
    }
    this.measure();
    this.redraw();
    if (this.in_space) this.space.redraw();
  }

  /// Scale and centre that show every layer of the visible robots.
  measure() {
    const [a, b] = state.axes, span = { a: [Infinity, -Infinity], b: [Infinity, -Infinity] };
    const widen = (range, values) => {
      for (const v of values) {
        if (v < range[0]) range[0] = v;
        if (v > range[1]) range[1] = v;
      }
    };
    for (const robot of shown())
      for (const layer of ["estimate", "truth", "odometry"]) {
        const path = path_of(robot, layer);
        if (!path || !state.layers[layer]) continue;
        widen(span.a, path[a]);
        widen(span.b, path[b]);
      }
    if (!is_shown_team()) {
      widen(span.a, span_of(chosen_team().cloud[a]));
      widen(span.b, span_of(chosen_team().cloud[b]));
    } else if (state.layers.grid && from_above()) {
      widen(span.a, grid_corners("x"));
      widen(span.b, grid_corners("y"));
    }
    if (state.layers.alternatives)
      for (const path of alternatives.flatMap(other => other.robots.filter((_, r) => state.visible[r]))) {
        widen(span.a, path ? path[a] : []);
        widen(span.b, path ? path[b] : []);
      }
    const [west, east] = isFinite(span.a[0]) ? span.a : [0, 1], [south, north] = isFinite(span.b[0]) ? span.b : [0, 1];
    const room = 0.92, least_m = 1;
    this.base = {
      scale: room * Math.min(this.width / Math.max(east - west, least_m), (this.height - scale_bar_px) / Math.max(north - south, least_m)),
      x: (west + east) / 2, y: (south + north) / 2,
    };
  }

  view() {
    const { base, transform: t, width, height } = this;
    return {
      k: t.k * base.scale, width, height, ratio: this.ratio, moving: this.moving,
      ox: t.k * (width / 2 - base.scale * base.x) + t.x, oy: t.k * ((height - scale_bar_px) / 2 + base.scale * base.y) + t.y,
      points: total(robots, robot => robot.keyframes),
    };
  }

  draw() {
    if (!this.width) return;
    this.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    draw_map(this.context, this.view());
    this.draw_moment();
  }

  /// On a separate canvas, since it follows the pointer and the map below may be large.
  draw_moment() {
    if (!this.width) return;
    const context = this.overlay.getContext("2d");
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    if (state.moment) draw_moment(context, this.view());
  }

  /// Keyframes of the visible robots, for finding the one nearest to a point.
  keyframes() {
    const { paths } = chosen_team();
    if (this.tree && this.tree.axes === state.axes && this.tree.paths === paths) return this.tree;
    const [a, b] = state.axes, points = [];
    for (const { index } of shown())
      for (let i = 0; paths[index] && i < paths[index].t.length; ++i)
        if (isFinite(paths[index][a][i] + paths[index][b][i])) points.push({ robot: index, i });
    this.tree = d3.quadtree(points, p => paths[p.robot][a][p.i], p => paths[p.robot][b][p.i]);
    Object.assign(this.tree, { axes: state.axes, paths });
    return this.tree;
  }

  point(event) {
    if (event.buttons) return this.leave();
    const view = this.view(), reach = 16 / view.k;
    const at = this.keyframes().find((event.offsetX - view.ox) / view.k, (view.oy - event.offsetY) / view.k, reach);
    if (!at) return this.leave();
    const robot = robots[at.robot];
    point_at({ robot: at.robot, t: robot.estimate.t[at.i] });
    highlight(at.robot);
    this.tooltip.replaceChildren(...describe_keyframe(robot, at.i));
    this.tooltip.hidden = false;
    const { offsetWidth: width, offsetHeight: height } = this.tooltip, right = event.offsetX + 16 + width > this.width;
    Object.assign(this.tooltip.style, {
      left: `${right ? Math.max(4, event.offsetX - 16 - width) : event.offsetX + 16}px`,
      top: `${Math.max(4, Math.min(event.offsetY + 12, this.height - height - 4))}px`,
    });
  }

  leave() {
    this.tooltip.hidden = true;
    point_at(null);
    highlight(null);
  }
}

function describe_keyframe(robot, i) {
  const path = path_of(robot, "estimate"), t = path.t[i], rows = [element("b", {}, robot.id)];
  const row = (name, value) => rows.push(element("span", {}, `${name} `), value, element("br"));
  row("time", `${format.clock(t)}  (${d3.format(".3f")(report.start_s + t)} s)`);
  row("position", `${format.metres(path.x[i])}, ${format.metres(path.y[i])}${path.z ? `, ${format.metres(path.z[i])}` : ""} m`);
  if (!is_shown_team()) return rows.slice(0, -1);
  if (robot.sigma_m && isFinite(robot.sigma_m[i])) row("σ", `${format.metres(robot.sigma_team_m[i])} m within the team, ${format.metres(robot.sigma_m[i])} m from what holds the frame`);
  if (robot.errors) {
    const e = nearest_index(robot.errors.t, t);
    row("error", `${format.metres(robot.errors.error_m[e])} m${Math.abs(robot.errors.t[e] - t) > 1 ? ` (at ${format.clock(robot.errors.t[e])})` : ""}`);
  }
  const closures = lines_at[robot.index].get(i) || [], accepted = closures.filter(c => groups[lines.group[c]].status === "accepted").length;
  if (closures_total) row("closures", `${accepted} accepted${closures_drawn < closures_total ? " of those drawn" : ""}`);
  const places = closures.filter(c => line_shown(c) && is_place(groups[lines.group[c]]));
  for (const c of places.slice(0, described_closures)) row(...describe_closure(robot, c));
  if (places.length > described_closures) row(`and ${places.length - described_closures} more`, "");
  rows.pop();
  return rows;
}

/// The other robot, and what became of the closure.
function describe_closure(robot, c) {
  const other = lines.robot_i[c] === robot.index ? lines.robot_j[c] : lines.robot_i[c];
  const { kind, status, reason } = report.closures.reasons[lines.reason[c]], statistic = lines.statistic ? `, statistic ${d3.format(".3~g")(lines.statistic[c])}` : "";
  return [`${kind} with ${other === robot.index ? "itself" : shortened(robots[other].id)}`, `${reason || status}${statistic}`];
}

function map_description() {
  const with_truth = report.frame === "truth" ? ", with the truth" : "";
  return `Map of the trajectories of ${format.plural(robots.length, "robot")}${with_truth}. Arrow keys move, plus and minus zoom, 0 shows everything.`;
}
