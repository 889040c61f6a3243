// Position error over time or path length, per robot, and its distribution over the team.

const stated_sigmas = 3;
const error_view = { along: "t", scale: "linear", dead_reckoning: robots.length <= few_robots, stated: robots.length <= few_robots };
const least_error_m = 0.01;

const evaluated = () => shown().filter(robot => robot.errors);

const stated_layers = () => (error_view.stated ? evaluated().map(r => r.errors).filter(e => e.sigma_m) : []);

function error_scales(width, height) {
  const layers = evaluated().map(r => r.errors).concat(error_view.dead_reckoning ? evaluated().map(r => r.dead_reckoning_errors).filter(e => e) : []);
  const end = d3.max(layers, e => d3.max(e[error_view.along])) || 1, top = d3.max([...layers.map(e => d3.max(e.error_m)), ...stated_layers().map(e => stated_sigmas * d3.max(e.sigma_m))]) || 1;
  const start = Math.min(0, d3.min(layers, e => e[error_view.along][0]) || 0);
  const y = error_view.scale === "log" ? d3.scaleLog().domain([least_error_m, top * 1.1]).clamp(true) : d3.scaleLinear().domain([0, top * 1.04]);
  return { x: d3.scaleLinear().domain([start, end]).range([0, width]), y: y.range([height, 0]) };
}

/// Median and 90th percentile of the errors of all visible robots, in steps along the axis.
function team_course(x) {
  const [start, end] = x.domain(), steps = 80, errors = d3.range(steps).map(() => []);
  for (const robot of evaluated())
    robot.errors.error_m.forEach((error, i) => {
      const step = Math.floor((steps * (robot.errors[error_view.along][i] - start)) / (end - start));
      if (isFinite(error) && step >= 0) errors[Math.min(step, steps - 1)].push(error);
    });
  const filled = d3.range(steps).filter(s => errors[s].length);
  const sorted = filled.map(s => errors[s].sort(d3.ascending));
  return { along: filled.map(s => start + ((s + 0.5) * (end - start)) / steps), median: sorted.map(e => d3.quantile(e, 0.5)), p90: sorted.map(e => d3.quantile(e, 0.9)) };
}

function draw_team_course(context, x, y) {
  const course = team_course(x);
  context.strokeStyle = css("ink");
  for (const [values, width, dash] of [[course.median, 2.2, []], [course.p90, 1.4, [2, 3]]]) {
    context.lineWidth = width;
    context.setLineDash(dash);
    context.beginPath();
    trace(context, course.along, values, x, y);
    context.stroke();
  }
  context.setLineDash([]);
}

function draw_errors(context, x, y) {
  const many = robots.length > few_robots;
  const curve = (robot, errors, width, dash, alpha, values = errors.error_m) => {
    context.globalAlpha = fades(robot.index) ? 0.1 : state.highlight === robot.index ? 1 : alpha;
    context.strokeStyle = robot_colour(robot.index);
    context.lineWidth = width + (state.highlight === robot.index ? 0.8 : 0);
    context.setLineDash(dash);
    context.beginPath();
    trace(context, errors[error_view.along], values, x, y);
    context.stroke();
  };
  context.lineJoin = "round";
  for (const robot of evaluated()) {
    if (error_view.dead_reckoning && robot.dead_reckoning_errors) curve(robot, robot.dead_reckoning_errors, 1, [4, 3], many ? 0.16 : 0.8);
    if (error_view.stated && robot.errors.sigma_m) curve(robot, robot.errors, 1.2, [6, 3, 1, 3], many ? 0.16 : 0.8, robot.errors.sigma_m.map(s => stated_sigmas * s));
    curve(robot, robot.errors, many ? 1 : 1.7, [], many ? 0.16 : 1);
  }
  context.setLineDash([]);
  context.globalAlpha = 1;
  if (many && state.highlight === null) draw_team_course(context, x, y);
}

function mark_moment(svg, x, y, chart) {
  if (!state.moment || !state.visible[state.moment.robot]) return;
  const robot = robots[state.moment.robot], errors = robot.errors;
  if (!errors) return;
  const i = nearest_index(errors.t, state.moment.t), at = x(errors[error_view.along][i]);
  svg.append("line").attr("class", "base").attr("x1", at).attr("x2", at).attr("y2", chart.height).attr("stroke-opacity", 0.5);
  svg.append("circle").attr("cx", at).attr("cy", y(errors.error_m[i])).attr("r", 4).attr("fill", robot_colour(robot.index));
  const right = at > chart.width - 180;
  svg.append("text").attr("class", "mark").attr("x", at + (right ? -9 : 9)).attr("y", 4).attr("text-anchor", right ? "end" : "start")
    .text(`${shortened(robot.id)}  ${format.metres(errors.error_m[i])} m`);
}

/// The curve nearest to the pointer, at the pointer's time.
function find_moment(px, py, x, y) {
  const at = x.invert(px);
  let best = null, least = 40;
  for (const robot of evaluated()) {
    const { errors } = robot, i = nearest_index(errors[error_view.along], at);
    const away = Math.hypot((x(errors[error_view.along][i]) - px) / 2, y(errors.error_m[i]) - py);
    if (away < least) { least = away; best = { robot: robot.index, t: errors.t[i] }; }
  }
  highlight(best ? best.robot : null);
  point_at(best);
}

function quantile_chart(accuracy) {
  const curves = [["dead reckoning", accuracy.dead_reckoning_quantiles_m, "quiet", [4, 3]], ["estimate", accuracy.quantiles_m, "ink", []]]
    .filter(([, values]) => values.length);
  const ratio = (_, i, all) => i / (all.length - 1);
  return new Chart(by_id("errors-share"), {
    height: 320, label: "Ratio of true poses below an error",
    x_label: () => "error (m)", y_label: () => "ratio of poses below the error",
    format_y: v => `${Math.round(v * 100)} %`, format_x: d3.format("~g"),
    ticks_y: () => [0, 0.25, 0.5, 0.75, 0.9, 1],
    ticks_x: x => (error_view.scale === "log" ? decades(x) : x.ticks(4)),
    scales(width, height) {
      const top = d3.max(curves, c => c[1][c[1].length - 1]) || 1;
      const x = error_view.scale === "log" ? d3.scaleLog().domain([least_error_m, top]).clamp(true) : d3.scaleLinear().domain([0, top]);
      return { x: x.range([0, width]), y: d3.scaleLinear().range([height, 0]) };
    },
    draw(context, x, y) {
      for (const [, values, colour, dash] of curves) {
        context.strokeStyle = css(colour);
        context.lineWidth = colour === "ink" ? 2 : 1.3;
        context.setLineDash(dash);
        context.beginPath();
        trace(context, values, values.map(ratio), x, y);
        context.stroke();
      }
      context.setLineDash([]);
    },
    marks(svg, x, y, chart) {
      for (const [name, values, colour] of curves) {
        const height = colour === "ink" ? 0.14 : 0.6, at = x(values[Math.round(height * (values.length - 1))]);
        const left = at > chart.width - 112;
        svg.append("text").attr("x", at + (left ? -10 : 10)).attr("y", y(height) + 4).attr("text-anchor", left ? "end" : "start")
          .attr("class", colour === "ink" ? "mark" : null).text(name);
      }
    },
  });
}

const decades = scale => scale.ticks(5).filter(v => Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-9);

function write_errors() {
  if (!report.accuracy || !robots.some(r => r.errors)) return;
  show("errors-section");
  const chart = new Chart(by_id("errors-chart"), {
    height: 320, label: "Error of every robot's position over time",
    x_label: () => (error_view.along === "t" ? "time (min:s)" : "path length (m)"), y_label: () => "error (m)",
    ticks_x: (x, width) => (error_view.along === "t" ? clock_ticks(x, width) : x.ticks(Math.max(2, width / 90))),
    format_x: v => (error_view.along === "t" ? clock_label(v) : d3.format(",")(v)),
    ticks_y: y => (error_view.scale === "log" ? decades(y) : y.ticks(5)),
    format_y: d3.format("~g"),
    scales: error_scales, draw: draw_errors, marks: mark_moment, on_pointer: find_moment,
    on_leave() { point_at(null); highlight(null); },
  });
  const shares = quantile_chart(report.accuracy);
  for (const change of ["visibility", "highlight"]) changes.on(`${change}.errors`, chart.redraw);
  changes.on("moment.errors", once_per_frame(() => chart.mark()));
  const set = (key, value) => { error_view[key] = value; chart.redraw(); shares.redraw(); };
  by_id("errors-controls").append(
    choice("over", [["t", "time"], ["along_m", "path length"]], error_view.along, v => set("along", v)),
    choice("scale", [["linear", "linear"], ["log", "logarithmic"]], error_view.scale, v => set("scale", v)),
    report.accuracy.dead_reckoning ? check("dead reckoning (dashed)", error_view.dead_reckoning, v => set("dead_reckoning", v)) : "",
    robots.some(r => r.errors && r.errors.sigma_m) ? check(`${stated_sigmas} stated standard deviations (dash-dotted)`, error_view.stated, v => set("stated", v)) : "");
  const { rpe, share_within_3_sigma: within } = report.accuracy;
  by_id("errors-caption").textContent = "Position error at the stamps of the truth, after one rigid alignment of the whole team"
    + (report.accuracy.dead_reckoning ? "; dead reckoning after an alignment of its own." : ".")
    + (robots.length > few_robots ? " Thick: median of the visible robots; dotted: their 90th percentile." : "")
    + (within === undefined ? "" : ` ${d3.format(".1f")(100 * within)} % of the errors are within three stated standard deviations.`)
    + (rpe ? ` Relative pose error between successive poses: ${d3.format(".3f")(rpe.translation_rmse_m)} m and ${format.degrees(rpe.rotation_rmse_rad)}° RMSE.` : "");
}
