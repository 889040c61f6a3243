// Signal strength of the strongest access points over time, and similarity of a chosen fingerprint to the
// others of its robot.

const signal_of = { robot: null, t: null };  // the fingerprint nearest to t; null: the one in the middle
const signal_palette = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#999933", "#882255"];

function time_scale(columns, width) {
  const [from, to] = d3.extent(columns.flatMap(c => [c.t[0], c.t[c.t.length - 1]]));
  return d3.scaleLinear().domain([from, Math.max(to, from + 1)]).range([0, width]);
}

function draw_columns(context, x, y, columns, key, colour) {
  columns.forEach((column, c) => {
    context.strokeStyle = colour(column, c);
    context.lineWidth = 1.4;
    context.beginPath();
    trace(context, column.t, column[key], x, y);
    context.stroke();
  });
}

const signals_chosen = () => report.signals.signals.filter(s => s.robot === signal_of.robot);
const similarity_of_robot = () => report.signals.similarity.filter(s => s.robot === signal_of.robot);
const similarity_chosen = () => {
  const all = similarity_of_robot(), wanted = signal_of.t;
  if (!all.length) return [];
  return [wanted === null ? all[Math.floor(all.length / 2)] : all[d3.scan(all, (a, b) => Math.abs(a.of_t - wanted) - Math.abs(b.of_t - wanted))]];
};

function signal_keys() {
  by_id("signals-key").replaceChildren(...signals_chosen().map((s, i) => element("span", { class: "key" },
    swatch(line => line.attr("stroke", signal_palette[i % signal_palette.length]).attr("stroke-width", 2)), s.bssid)));
}

function write_signals() {
  if (!report.signals || !report.signals.signals.length) return;
  show("signals-section");
  const names = [...new Set(report.signals.signals.map(s => s.robot))];
  signal_of.robot = names[0];
  const strength = new Chart(by_id("signals-chart"), {
    height: 260, label: "Signal strength of the strongest access points over time",
    x_label: () => "time", y_label: () => "signal strength (dBm)", ticks_x: clock_ticks, format_x: clock_label,
    scales(width, height) {
      const [low, high] = d3.extent(signals_chosen().flatMap(s => s.rss_dbm));
      return { x: time_scale(signals_chosen(), width), y: d3.scaleLinear().domain([low, Math.max(high, low + 1)]).nice().range([height, 0]) };
    },
    draw(context, x, y) { draw_columns(context, x, y, signals_chosen(), "rss_dbm", (_, c) => signal_palette[c % signal_palette.length]); },
  });
  const likeness = new Chart(by_id("signals-similarity"), {
    height: 220, label: "Similarity of one fingerprint to the others of its robot, over time",
    x_label: () => "time", y_label: () => "similarity to the marked fingerprint", ticks_x: clock_ticks, format_x: clock_label,
    scales(width, height) {
      const columns = similarity_chosen().length ? similarity_chosen() : [{ t: [0, 1] }];
      return { x: time_scale(columns, width), y: d3.scaleLinear().domain([0, 1]).range([height, 0]) };
    },
    draw(context, x, y) {
      draw_columns(context, x, y, similarity_chosen(), "similarity", () => css("accent"));
      for (const over of similarity_chosen()) {
        context.strokeStyle = css("ink");
        context.setLineDash([4, 3]);
        context.beginPath();
        context.moveTo(x(over.of_t), y(0));
        context.lineTo(x(over.of_t), y(1));
        context.stroke();
        context.setLineDash([]);
      }
    },
  });
  likeness.canvas.style("cursor", "crosshair").on("click", () => {
    signal_of.t = likeness.x.invert(d3.mouse(likeness.canvas.node())[0] - likeness.margin.left);
    likeness.redraw();
  });
  const list = element("select", { "aria-label": "robot", onchange: () => { signal_of.robot = list.value; signal_of.t = null; signal_keys(); strength.redraw(); likeness.redraw(); } },
    ...names.map(name => element("option", { value: name }, name)));
  if (names.length > 1) by_id("signals-controls").append(element("span", { class: "check" }, "robot", list));
  signal_keys();
}
