// Charts of a study of rendezvous: lines, bars in groups, histograms. A series has one colour in all of them.

const plot = { width: 560, height: 330, left: 56, right: 16, top: 28, bottom: 46 };
const shades = 6;
const series_shades = new Map();
const number_text = v => (known(v) ? minus(d3.format(Math.abs(v) >= 100 ? ",.0f" : ".3~r")(v)) : missing);

/// Of the colours that no other series of the chart has, the one used least so far.
function shade_of(chart, name) {
  if (!series_shades.has(name)) {
    const here = chart.series.map(series => series_shades.get(series.name)), all = Array.from(series_shades.values());
    const free = d3.range(shades).filter(k => !here.includes(k)), open = free.length ? free : d3.range(shades);
    const uses = k => all.filter(other => other === k).length;
    series_shades.set(name, open[d3.scan(open, (a, b) => uses(a) - uses(b))]);
  }
  return `var(--method-${series_shades.get(name)})`;
}
const colour_of = (chart, series) => series.colour || shade_of(chart, series.name);
/// Dashed where an earlier series of the chart has the same colour.
const dash_of = (chart, k) => (chart.series.slice(0, k).some(other => colour_of(chart, other) === colour_of(chart, chart.series[k])) ? "6 4" : null);

function write_key(parent, chart, solid) {
  const key = d3.select(parent).append("div").attr("class", "legend");
  const entry = (name, draw) => {
    const item = key.append("span");
    draw(item.append("svg").attr("viewBox", "0 0 30 10").attr("aria-hidden", "true"));
    item.append("span").text(name);
  };
  chart.series.forEach((series, k) => entry(series.name, svg => (solid ? svg.append("rect").attr("width", 26).attr("height", 10).style("fill", colour_of(chart, series))
    : svg.append("path").attr("d", "M0 5H28").style("stroke-width", 2).style("stroke", colour_of(chart, series)).style("stroke-dasharray", dash_of(chart, k)))));
  if (chart.curve) entry(chart.curve.name, svg => svg.append("path").attr("class", "curve").attr("d", "M0 5H28").style("stroke-width", 2));
}

/// Breaks a name into lines of about so many letters.
const broken = (text, letters) => text.split(" ").reduce((lines, word) => {
  const last = lines[lines.length - 1];
  return last && last.length + word.length < letters ? lines.slice(0, -1).concat(`${last} ${word}`) : lines.concat(word);
}, []);

/// Grid and axes. ticks: places on the horizontal axis, and what to write there.
function draw_axes(parent, chart, y, ticks, letters = Infinity) {
  const svg = d3.select(parent).append("svg").attr("viewBox", `0 0 ${plot.width} ${plot.height}`).attr("role", "img").attr("aria-label", `${chart.title}: ${chart.y}${chart.x ? ` over ${chart.x}` : ""}`);
  const floor_y = plot.height - plot.bottom, text_y = y.tickFormat(5);
  for (const v of y.ticks(5)) {
    svg.append("line").attr("x1", plot.left).attr("x2", plot.width - plot.right).attr("y1", y(v)).attr("y2", y(v));
    svg.append("text").attr("x", plot.left - 8).attr("y", y(v) + 4).attr("text-anchor", "end").text(minus(text_y(v)));
  }
  for (const [at, name] of ticks)
    broken(name, letters).forEach((line, k) => svg.append("text").attr("x", at).attr("y", floor_y + 17 + 14 * k).attr("text-anchor", "middle").text(line));
  svg.append("text").attr("x", 0).attr("y", 12).text(chart.y);
  if (chart.x) svg.append("text").attr("x", plot.width - plot.right).attr("y", plot.height - 8).attr("text-anchor", "end").text(chart.x);
  return svg;
}

const number_ticks = x => x.ticks(6).map(v => [x(v), minus(x.tickFormat(6)(v))]);
const across = extent => d3.scaleLinear().domain(extent).range([plot.left, plot.width - plot.right]);
const upwards = values => d3.scaleLinear().domain([Math.min(0, d3.min(values) || 0), d3.max(values) || 1]).nice(5).range([plot.height - plot.bottom, plot.top]);

/// Upright lines with names; a name is left out where it would cover the last one.
function draw_events(svg, marks, x) {
  let last = -Infinity;
  for (const mark of marks.slice().sort((a, b) => a.x - b.x)) {
    const at = x(mark.x);
    svg.append("line").attr("class", "bound").attr("x1", at).attr("x2", at).attr("y1", plot.top).attr("y2", plot.height - plot.bottom).append("title").text(mark.name);
    if (at - last < 14) continue;
    svg.append("text").attr("class", "haloed").attr("transform", `translate(${at - 4},${plot.top + 2}) rotate(-90)`).attr("text-anchor", "end").text(mark.name);
    last = at;
  }
}

function draw_lines(parent, chart) {
  const points = chart.series.flatMap(series => series.points.concat((series.band || []).flatMap(([x, low, high]) => [[x, low], [x, high]]))).filter(p => known(p[1]));
  const x = across(d3.extent(points, p => p[0])), y = upwards(points.map(p => p[1]).concat(known(chart.threshold) ? [chart.threshold] : []));
  const svg = draw_axes(parent, chart, y, number_ticks(x));
  const band = d3.area().defined(p => known(p[1]) && known(p[2])).x(p => x(p[0])).y0(p => y(p[1])).y1(p => y(p[2]));
  for (const series of chart.series) if (series.band) svg.append("path").attr("class", "band").attr("d", band(series.band)).style("fill", colour_of(chart, series));
  if (known(chart.threshold)) svg.append("line").attr("class", "bound").attr("x1", plot.left).attr("x2", plot.width - plot.right).attr("y1", y(chart.threshold)).attr("y2", y(chart.threshold));
  draw_events(svg, chart.marks || [], x);
  const line = d3.line().defined(p => known(p[1])).x(p => x(p[0])).y(p => y(p[1]));
  chart.series.forEach((series, k) => {
    svg.append("path").attr("d", line(series.points)).style("stroke", colour_of(chart, series)).style("stroke-dasharray", dash_of(chart, k)).append("title").text(series.name);
    if (series.points.length <= 30)
      series.points.filter(p => known(p[1])).forEach(p => svg.append("circle").attr("cx", x(p[0])).attr("cy", y(p[1])).attr("r", 3).style("fill", colour_of(chart, series)).append("title").text(`${series.name}, ${number_text(p[0])}: ${number_text(p[1])}`));
  });
  if (known(chart.threshold)) svg.append("text").attr("class", "haloed").attr("x", plot.left + 4).attr("y", y(chart.threshold) - 5).text(`threshold ${number_text(chart.threshold)}`);
  return { svg, x };
}

function draw_bars(parent, chart) {
  const high = (series, g) => (series.values[g] || 0) + (series.spread && series.spread[g] || 0);
  const y = upwards(chart.series.flatMap(series => series.values.map((_, g) => high(series, g))));
  const groups = d3.scaleBand().domain(d3.range(chart.groups.length)).range([plot.left, plot.width - plot.right]).padding(0.2);
  const bars = d3.scaleBand().domain(d3.range(chart.series.length)).range([0, groups.bandwidth()]).padding(0.12);
  const svg = draw_axes(parent, chart, y, chart.groups.map((name, g) => [groups(g) + groups.bandwidth() / 2, name]), groups.step() / 6.5);
  chart.series.forEach((series, k) => series.values.forEach((v, g) => {
    const left = groups(g) + bars(k), middle = left + bars.bandwidth() / 2, spread = series.spread && series.spread[g], text = `${number_text(v)}${known(spread) ? ` ± ${number_text(spread)}` : ""}`;
    const bar = svg.append("g");
    bar.append("title").text(`${series.name}, ${chart.groups[g]}: ${text}`);
    if (known(v)) bar.append("rect").attr("x", left).attr("y", y(Math.max(0, v))).attr("width", bars.bandwidth()).attr("height", Math.abs(y(v) - y(0))).style("fill", colour_of(chart, series));
    if (known(v) && known(spread)) bar.append("path").attr("class", "spread").attr("d", `M${middle} ${y(v - spread)}V${y(v + spread)}m-4 0h8M${middle - 4} ${y(v - spread)}h8`);
    bar.append("text").attr("class", "haloed").attr("x", middle).attr("y", y(Math.max(0, high(series, g))) - 5).attr("text-anchor", "middle").text(number_text(v));
  }));
}

function draw_histogram(parent, chart) {
  const shares = chart.series.flatMap(series => series.shares).concat(chart.curve ? chart.curve.points.map(p => p[1]) : []);
  const x = across([chart.edges[0], chart.edges[chart.edges.length - 1]]), y = upwards(shares);
  const svg = draw_axes(parent, chart, y, number_ticks(x));
  const steps = d3.area().curve(d3.curveStepAfter).x((_, k) => x(chart.edges[k])).y0(y(0)).y1(v => y(v || 0));
  for (const series of chart.series) {
    const shape = svg.append("path").attr("class", "steps").attr("d", steps(series.shares.concat(series.shares.slice(-1)))).style("fill", colour_of(chart, series)).style("stroke", colour_of(chart, series));
    shape.append("title").text(series.name);
  }
  const within = p => p[0] >= x.domain()[0] && p[0] <= x.domain()[1];
  if (chart.curve) svg.append("path").attr("class", "curve").attr("d", d3.line().x(p => x(p[0])).y(p => y(p[1]))(chart.curve.points.filter(within))).append("title").text(chart.curve.name);
}

function write_chart(chart) {
  const cell = element("div", {}, element("h3", {}, chart.title));
  by_id("rendezvous-charts").append(cell);
  write_key(cell, chart, chart.kind !== "lines");
  ({ lines: draw_lines, bars: draw_bars, histogram: draw_histogram })[chart.kind](cell, chart);
  if (chart.caption) cell.append(element("p", { class: "caption" }, chart.caption));
}
