// Chart: grid and axes in SVG over a canvas for the data. It follows its container's width.
//   plot: {height, label, x_label, y_label, scales(width, height) -> {x, y}, draw(context, x, y, chart),
//          ticks_x, ticks_y, marks(svg, x, y), on_pointer(px, py, x, y), on_leave()}

class Chart {
  constructor(parent, plot) {
    this.plot = plot;
    this.margin = { top: 24, right: 14, bottom: 40, left: 46 };
    this.root = d3.select(parent).append("div").attr("class", "chart").style("height", `${plot.height}px`);
    this.canvas = this.root.append("canvas").attr("role", "img").attr("aria-label", plot.label);
    this.svg = this.root.append("svg").attr("aria-hidden", "true");
    this.redraw = once_per_frame(() => this.draw());
    if (plot.on_pointer) this.listen();
    new ResizeObserver(this.redraw).observe(this.root.node());
    changes.on(`theme.chart${Chart.count++}`, this.redraw);
  }

  listen() {
    this.canvas.on("mousemove", () => {
      const [px, py] = d3.mouse(this.canvas.node());
      this.plot.on_pointer(px - this.margin.left, py - this.margin.top, this.x, this.y, this);
    });
    this.canvas.on("mouseleave", () => this.plot.on_leave());
  }

  draw() {
    const { margin, plot } = this, ratio = window.devicePixelRatio || 1;
    const outer = this.root.node().clientWidth;
    if (outer < margin.left + margin.right + 40) return;
    this.width = outer - margin.left - margin.right;
    this.height = plot.height - margin.top - margin.bottom;
    const { x, y } = plot.scales(this.width, this.height);
    this.x = x;
    this.y = y;
    this.canvas.attr("width", Math.round(outer * ratio)).attr("height", Math.round(plot.height * ratio))
      .style("width", `${outer}px`).style("height", `${plot.height}px`);
    this.svg.attr("width", outer).attr("height", plot.height).selectAll("*").remove();
    const inner = this.svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
    this.axes(inner, x, y);
    const context = this.canvas.node().getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, margin.left * ratio, margin.top * ratio);
    this.grid(context, y);
    context.save();
    context.beginPath();
    context.rect(0, -6, this.width + 6, this.height + 6);
    context.clip();
    plot.draw(context, x, y, this);
    context.restore();
    this.marks = inner.append("g");
    this.mark();
  }

  /// Redraws the marks above the data on their own.
  mark() {
    if (!this.marks || !this.plot.marks) return;
    this.marks.selectAll("*").remove();
    this.plot.marks(this.marks, this.x, this.y, this);
  }

  ticks_y(y) { return this.plot.ticks_y ? this.plot.ticks_y(y) : y.ticks(Math.max(3, this.height / 55)); }

  grid(context, y) {
    context.strokeStyle = css("grid");
    context.lineWidth = 1;
    context.beginPath();
    for (const tick of this.ticks_y(y)) {
      const at = Math.round(y(tick)) + 0.5;
      context.moveTo(0, at);
      context.lineTo(this.width, at);
    }
    context.stroke();
  }

  axes(inner, x, y) {
    const { plot, width, height } = this;
    const text_x = plot.format_x || (v => minus(String(v))), text_y = plot.format_y || (v => minus(String(v)));
    for (const tick of this.ticks_y(y))
      inner.append("text").attr("x", -9).attr("y", y(tick)).attr("dy", "0.33em").attr("text-anchor", "end").text(text_y(tick));
    inner.append("line").attr("class", "base").attr("x2", width).attr("y1", height + 0.5).attr("y2", height + 0.5);
    for (const tick of plot.ticks_x ? plot.ticks_x(x, width) : x.ticks(Math.max(2, width / 90))) {
      inner.append("line").attr("class", "base").attr("x1", x(tick)).attr("x2", x(tick)).attr("y1", height).attr("y2", height + 5);
      inner.append("text").attr("x", x(tick)).attr("y", height + 18).attr("text-anchor", "middle").text(text_x(tick));
    }
    inner.append("text").attr("x", -this.margin.left).attr("y", -12).text(plot.y_label());
    inner.append("text").attr("x", width).attr("y", height + 34).attr("text-anchor", "end").text(plot.x_label());
  }
}
Chart.count = 0;

/// A polyline through columns, without points that coincide with the last one drawn.
function trace(context, xs, ys, x, y) {
  let px = NaN, py = NaN, begun = false;
  for (let i = 0; i < xs.length; ++i) {
    const at_x = x(xs[i]), at_y = y(ys[i]);
    if (!isFinite(at_x) || !isFinite(at_y)) { begun = false; continue; }
    if (begun && i + 1 < xs.length && Math.abs(at_x - px) < 0.6 && Math.abs(at_y - py) < 0.6) continue;
    if (begun) context.lineTo(at_x, at_y);
    else context.moveTo(at_x, at_y);
    begun = true;
    px = at_x;
    py = at_y;
  }
}

/// Ticks of a time axis in seconds, at round minutes and hours.
function clock_ticks(x, width) {
  const [from, to] = x.domain(), wanted = (to - from) / Math.max(2, width / 90);
  const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 21600, 43200, 86400];
  const step = steps.find(s => s >= wanted) || Math.ceil(wanted / 86400) * 86400;
  return d3.range(Math.ceil(from / step) * step, to + 1e-9, step);
}
function clock_label(v) {
  const rest = d3.format("02d"), hours = Math.floor(v / 3600), minutes = Math.floor((v % 3600) / 60);
  return hours ? `${hours}:${rest(minutes)}:${rest(v % 60)}` : `${minutes}:${rest(v % 60)}`;
}

/// A row of mutually exclusive options.
function choice(name, options, chosen, on_change) {
  const inputs = options.map(([value, text]) => element("label", {},
    element("input", { type: "radio", name, value, ...(value === chosen ? { checked: true } : {}), onchange: () => on_change(value) }), text));
  return element("span", { class: "choice", role: "radiogroup", "aria-label": name }, ...inputs);
}
function check(text, checked, on_change) {
  const box = element("input", { type: "checkbox", ...(checked ? { checked: true } : {}), onchange: () => on_change(box.checked) });
  return element("label", { class: "check" }, box, text);
}
