// Access points: on the map with a one-sigma ellipse, and in a table. Of a selected one, the readings: on the map, coloured
// by signal strength, with the circles on which the strongest alone would place it; and over their distance, with its path loss.

const points = report.access_points ? report.access_points.points : [];
const free_space = { transmitted_dbm: 20, constant_db: 32.44 };  // typical transmit power; Friis, km and MHz
const table_rows = 200;
const circles_shown = { of: "law" };
const circle_count = 12;

const point_colour = () => (is_dark() ? "#f2f2f2" : "#222222");

/// Free space loss in dB at a distance in metres.
const free_loss_db = (point, metres) => 20 * Math.log10(metres / 1000) + 20 * Math.log10(point.frequency_mhz) + free_space.constant_db;
const law_dbm = (point, metres) => point.p0_dbm - 10 * point.exponent * Math.log10(metres);

/// Colour of a signal strength, from the weakest to the strongest reading of the access point.
function reading_colour(point) {
  const [low, high] = d3.extent(point.heard, reading => reading[2]), from = is_dark() ? 0.22 : 0.02;
  return dbm => d3.interpolateViridis(from + (0.95 - from) * (high > low ? (dbm - low) / (high - low) : 1));
}

/// Distance of the access point by the strength of one reading, metres.
function circle_radius(point, dbm) {
  if (circles_shown.of === "law") return 10 ** ((point.p0_dbm - dbm) / (10 * point.exponent));
  const loss = free_space.transmitted_dbm - dbm - 20 * Math.log10(point.frequency_mhz) - free_space.constant_db;
  return 1000 * 10 ** (loss / 20);
}

function draw_ellipse(context, view, point) {
  context.beginPath();
  context.ellipse(view.ox + view.k * point.x, view.oy - view.k * point.y, view.k * point.major_m, view.k * point.minor_m, -point.turn_rad, 0, 2 * Math.PI);
  context.globalAlpha = 0.1;
  context.fill();
  context.globalAlpha = 0.55;
  context.stroke();
}

function draw_mark(context, px, py, size, filled) {
  context.beginPath();
  context.moveTo(px, py - size);
  context.lineTo(px + size, py);
  context.lineTo(px, py + size);
  context.lineTo(px - size, py);
  context.closePath();
  if (filled) context.fill();
  context.stroke();
}

function draw_circles(context, view, point) {
  context.strokeStyle = css("accent");
  context.lineWidth = 1;
  context.globalAlpha = 0.5;
  for (const [x, y, dbm] of [...point.heard].sort((a, b) => b[2] - a[2]).slice(0, circle_count)) {
    context.beginPath();
    context.arc(view.ox + view.k * x, view.oy - view.k * y, view.k * circle_radius(point, dbm), 0, 2 * Math.PI);
    context.stroke();
  }
  context.globalAlpha = 1;
}

function draw_readings(context, view, point) {
  const colour = reading_colour(point);
  for (const [x, y, dbm] of point.heard) {
    context.fillStyle = colour(dbm);
    context.beginPath();
    context.arc(view.ox + view.k * x, view.oy - view.k * y, 4, 0, 2 * Math.PI);
    context.fill();
  }
}

/// Only in the view from above: heights are not estimated.
function draw_access_points(context, view) {
  if (state.axes[0] !== "x" || state.axes[1] !== "y") return;
  const chosen = points[state.access_point];
  if (chosen) draw_readings(context, view, chosen);
  if (chosen && circles_shown.of !== "none") draw_circles(context, view, chosen);
  context.lineWidth = 1;
  for (const point of points) {
    const px = view.ox + view.k * point.x, py = view.oy - view.k * point.y;
    context.fillStyle = context.strokeStyle = point === chosen ? css("accent") : point_colour();
    if (point.known !== "loose" && !view.moving && (!chosen || point === chosen)) draw_ellipse(context, view, point);
    context.globalAlpha = point.known === "loose" ? 0.45 : 1;
    draw_mark(context, px, py, point === chosen ? 7 : 4.5, point.known === "found");
    if (point.known !== "ambiguous" || !point.rival) continue;
    const qx = view.ox + view.k * point.rival[0], qy = view.oy - view.k * point.rival[1];
    context.globalAlpha = 0.4;
    context.setLineDash([2, 4]);
    context.beginPath();
    context.moveTo(px, py);
    context.lineTo(qx, qy);
    context.stroke();
    draw_mark(context, qx, qy, 4, false);
    context.setLineDash([]);
  }
  context.globalAlpha = 1;
}

const points_selector = { list: null, chart: null };

function choose_point(index) {
  state.access_point = index;
  if (index !== null) state.layers.access_points = true;
  points_selector.list.value = index === null ? "" : String(index);
  by_id("points-chart").hidden = index === null;
  points_selector.chart.redraw();
  changes.call("layers");
  changes.call("theme");  // the panel's box
  write_points_table();
}

function write_points_table() {
  const order = d3.range(points.length).sort((a, b) => points[b].readings - points[a].readings).slice(0, table_rows);
  const number = text => element("td", { class: "number" }, text), decibels = v => (known(v) ? minus(d3.format(".1f")(v)) : missing);
  const rows = order.map(i => {
    const p = points[i], chosen = state.access_point === i;
    const name = element("button", { type: "button", class: "plain", "aria-pressed": String(chosen), onclick: () => choose_point(chosen ? null : i) }, chosen ? `${p.bssid} ✓` : p.bssid);
    return element("tr", {}, element("td", {}, name), number(`${format.metres(p.x)}, ${format.metres(p.y)}`),
      number(`${format.metres(p.major_m)} / ${format.metres(p.minor_m)}`), number(decibels(p.p0_dbm)), number(known(p.exponent) ? d3.format(".2f")(p.exponent) : missing),
      number(decibels(p.sigma_db)), number(format.count(p.readings)), element("td", {}, p.known));
  });
  const heads = ["access point", "position (m)", "1 σ, long / short (m)", "power at 1 m (dBm)", "exponent", "σ (dB)", "readings", ""];
  by_id("points-table").replaceChildren(element("table", {}, element("thead", {}, element("tr", {}, ...heads.map((h, i) => element("th", { scope: "col", class: i > 0 && i < 7 ? "number" : null }, h)))), element("tbody", {}, ...rows)));
}

const distance_of = (point, [x, y]) => Math.max(1, Math.hypot(x - point.x, y - point.y));

function draw_law(context, x, y, strength_dbm, dash) {
  const [from, to] = x.domain();
  context.setLineDash(dash);
  context.beginPath();
  for (let share = 0; share <= 1.0001; share += 0.02) {
    const metres = from * (to / from) ** share;
    context.lineTo(x(metres), y(strength_dbm(metres)));
  }
  context.stroke();
  context.setLineDash([]);
}

/// Signal strength over distance of the selected access point.
function write_points_chart() {
  const parent = by_id("points-chart"), chosen = () => points[state.access_point];
  points_selector.chart = new Chart(parent, {
    height: 300, label: "Signal strength of the selected access point over the distance from its estimated position",
    x_label: () => "distance from the estimated position (m)", y_label: () => "signal strength (dBm)",
    ticks_x: x => x.ticks(6, "d").filter(t => [1, 2, 5].includes(t / 10 ** Math.floor(Math.log10(t) + 1e-9))),
    scales(width, height) {
      const point = chosen(), heard = point ? point.heard : [];
      const [low, high] = heard.length ? d3.extent(heard, reading => reading[2]) : [-90, -40];
      const far = d3.max(heard, reading => distance_of(point, reading)) || 10;
      return { x: d3.scaleLog().domain([1, Math.max(far, 2)]).nice().range([0, width]), y: d3.scaleLinear().domain([low - 3, high + 3]).nice().range([height, 0]) };
    },
    draw(context, x, y) {
      const point = chosen();
      if (!point) return;
      const colour = reading_colour(point);
      for (const reading of point.heard) {
        context.fillStyle = colour(reading[2]);
        context.fillRect(x(distance_of(point, reading)) - 2, y(reading[2]) - 2, 4, 4);
      }
      context.lineWidth = 1.8;
      context.strokeStyle = css("ink");
      if (known(point.p0_dbm) && known(point.exponent)) draw_law(context, x, y, metres => law_dbm(point, metres), []);
      if (point.frequency_mhz > 0) draw_law(context, x, y, metres => free_space.transmitted_dbm - free_loss_db(point, metres), [5, 4]);
    },
  });
}

function points_list(order) {
  const list = element("select", { "aria-label": "access point", onchange: () => choose_point(list.value === "" ? null : Number(list.value)) },
    element("option", { value: "" }, "none"), ...order.map(i => element("option", { value: String(i) }, `${points[i].bssid} (${format.count(points[i].readings)})`)));
  return points_selector.list = list;
}

function write_access_points() {
  if (!points.length) return;
  show("points-section");
  const by_readings = d3.range(points.length).sort((a, b) => points[b].readings - points[a].readings);
  by_id("points-controls").append(element("span", { class: "check" }, "access point", points_list(by_readings)));
  write_points_chart();
  const { placed } = report.access_points;
  by_id("points-controls").append(element("span", {}, "circles around its strongest readings"),
    choice("circles", [["law", "by its path loss"], ["free", "in free space"], ["none", "none"]], circles_shown.of, of => { circles_shown.of = of; changes.call("layers"); }));
  const loose = points.filter(p => p.known === "loose").length, parts = [
    `${format.plural(placed, "access point")} received in enough places; ellipses are 1 σ.`,
    "Select one to see its readings on the map, coloured by signal strength, with distance circles of the strongest; and over their distance: solid its estimated path loss, dashed free space at 20 dBm transmit power."];
  if (loose) parts.push(`${format.count(loose)} hollow and faint: poorly constrained.`);
  if (points.some(p => p.known === "ambiguous")) parts.push("Ambiguous ones are hollow and connected to the alternative position.");
  if (points.length < placed) parts.push(`${format.count(points.length)} are drawn.`);
  if (points.length > table_rows) parts.push(`The ${table_rows} with the most readings are listed; all are in access_points.csv.`);
  if (points.length > 12) by_id("points-table").classList.add("tall");
  by_id("points-caption").textContent = parts.join(" ");
  write_points_table();
}
