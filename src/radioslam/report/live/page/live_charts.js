// Error, stated uncertainty and what is known of the team, over time.

/// series: () -> [{points: [[t, value], ...], colour, dash}]
function live_chart(host, height, label, y_label, most, series) {
  const points = () => series().flatMap(of => of.points);
  return new Chart(host, {
    height, label, x_label: () => "time (min:s)", y_label: () => y_label,
    ticks_x: clock_ticks, format_x: clock_label, ticks_y: y => y.ticks(4), format_y: d3.format("~g"),
    scales: (width, room) => ({
      x: d3.scaleLinear().domain([0, Math.max(1, live.t)]).range([0, width]),
      y: d3.scaleLinear().domain([0, most || 1.08 * (d3.max(points(), p => p[1]) || 1)]).range([room, 0]),
    }),
    draw(context, x, y) {
      for (const { points: line, colour, dash } of series()) {
        context.strokeStyle = colour;
        context.lineWidth = 1.7;
        context.setLineDash(dash || []);
        context.beginPath();
        trace(context, line.map(p => p[0]), line.map(p => p[1]), x, y);
        context.stroke();
      }
      context.setLineDash([]);
    },
  });
}

const charts = {};
const errors_known = () => live.known.filter(of => known(of.error_m)).map(of => [of.t, of.error_m]);
const own_colour = () => robot_colour(Math.max(0, robots.findIndex(robot => robot.id === report.self)));

function update_charts() {
  const has_error = errors_known().length > 0;
  if (!charts.error && (has_error || live.sigmas.length > 1)) {
    show("error-section");
    charts.error = live_chart(by_id("error-chart"), 220, "Error of the estimate and stated uncertainty over time", "metres", null, () => [
      { points: errors_known(), colour: css("ink") },
      { points: live.sigmas.map(of => [of.t, of.sigma_team_m]), colour: own_colour(), dash: [5, 4] }]);
  }
  if (!charts.share && live.known.length > 1) {
    show("share-section");
    charts.share = live_chart(by_id("share-chart"), 170, "Share of the team's records that are known, over time", "known (%)", 100, () => [
      { points: live.known.map(of => [of.t, 100 * of.share]), colour: own_colour() }]);
  }
  by_id("error-caption").textContent = `${has_error ? "Solid: error of the frame with the most robots against the truth, after one rigid alignment. " : ""}Dashed: stated σ of this robot's position within the team, while the page is open.`;
  for (const chart of Object.values(charts)) chart.redraw();
}
