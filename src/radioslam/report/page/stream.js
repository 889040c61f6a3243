// The estimate as it was known: its error, or the number of frames, over time; when robots came to share a frame; what moved.

const stream_rows = 100;

function draw_stream(context, x, y, points) {
  context.strokeStyle = css("accent");
  context.lineWidth = 1.7;
  context.beginPath();
  trace(context, points.map(p => p.t), points.map(p => p.value), x, y);
  context.stroke();
  context.fillStyle = css("accent");
  for (const point of points.filter(p => p.effort === "align")) {
    context.beginPath();
    context.arc(x(point.t), y(point.value), 3.5, 0, 2 * Math.PI);
    context.fill();
  }
}

function write_stream() {
  if (!report.stream) return;
  show("stream-section");
  const { estimates, events } = report.stream, has_error = estimates.some(e => known(e.error_m));
  const points = estimates.filter(e => !has_error || known(e.error_m)).map(e => ({ ...e, value: has_error ? e.error_m : e.frames }));
  const joins = events.filter(e => e.join);
  new Chart(by_id("stream-chart"), {
    height: 260, label: has_error ? "Error of the estimate as it was known, over time" : "Frames of the team over time",
    x_label: () => "time (min:s)", y_label: () => (has_error ? "error (m)" : "frames"),
    ticks_x: clock_ticks, format_x: clock_label, ticks_y: y => y.ticks(5), format_y: d3.format("~g"),
    scales: (width, height) => ({
      x: d3.scaleLinear().domain([Math.min(0, d3.min(points, p => p.t) || 0), d3.max(points, p => p.t) || 1]).range([0, width]),
      y: d3.scaleLinear().domain([0, 1.05 * (d3.max(points, p => p.value) || 1)]).range([height, 0]),
    }),
    draw: (context, x, y) => draw_stream(context, x, y, points),
    marks(svg, x, y, chart) {
      for (const join of joins)
        svg.append("line").attr("class", "base").attr("x1", x(join.t)).attr("x2", x(join.t)).attr("y2", chart.height)
          .attr("stroke-dasharray", "3 4").append("title").text(join.what);
    },
  });
  by_id("stream-events").append(element("table", {}, element("tbody", {}, ...events.slice(0, stream_rows).map(e =>
    element("tr", {}, element("td", { class: "number" }, format.clock(e.t)), element("td", { class: "text" }, e.what))))));
  by_id("stream-caption").textContent = (has_error ? "Error of the frame with the most robots, as far as it was known then, after one rigid alignment." : "Frames that share no robot.")
    + " Dots: all alignments were searched. Dashed: a robot comes into another frame."
    + (events.length > stream_rows ? ` The first ${stream_rows} of ${events.length} events; the others are in summary.json.` : "");
}
