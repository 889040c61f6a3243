// Access points: on the map with a one-sigma ellipse, in a table, and for the readings of a selected one the circles
// on which its signal strength alone would place it.

const points = report.access_points ? report.access_points.points : [];
const free_space = { transmitted_dbm: 20, constant_db: 32.44 };  // typical transmit power; Friis, km and MHz
const table_rows = 200;
const circles_shown = { of: "law" };

const point_colour = () => (is_dark() ? "#f2f2f2" : "#222222");

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
  for (const [x, y, dbm] of point.heard) {
    const px = view.ox + view.k * x, py = view.oy - view.k * y;
    context.globalAlpha = 0.5;
    context.beginPath();
    context.arc(px, py, view.k * circle_radius(point, dbm), 0, 2 * Math.PI);
    context.stroke();
    context.globalAlpha = 1;
    context.fillStyle = css("accent");
    context.fillRect(px - 2, py - 2, 4, 4);
  }
}

/// Only in the view from above: heights are not estimated.
function draw_access_points(context, view) {
  if (state.axes[0] !== "x" || state.axes[1] !== "y") return;
  const chosen = points[state.access_point];
  if (chosen && circles_shown.of !== "none") draw_circles(context, view, chosen);
  context.lineWidth = 1;
  for (const point of points) {
    const px = view.ox + view.k * point.x, py = view.oy - view.k * point.y;
    context.fillStyle = context.strokeStyle = point === chosen ? css("accent") : point_colour();
    if (point.known !== "loose" && !view.moving) draw_ellipse(context, view, point);
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

function choose_point(index) {
  state.access_point = state.access_point === index ? null : index;
  if (state.access_point !== null) state.layers.access_points = true;
  changes.call("layers");
  changes.call("theme");  // the panel's box
  write_points_table();
}

function write_points_table() {
  const order = d3.range(points.length).sort((a, b) => points[b].readings - points[a].readings).slice(0, table_rows);
  const number = text => element("td", { class: "number" }, text), decibels = v => (known(v) ? minus(d3.format(".1f")(v)) : missing);
  const rows = order.map(i => {
    const p = points[i], chosen = state.access_point === i;
    const name = element("button", { type: "button", class: "plain", "aria-pressed": String(chosen), onclick: () => choose_point(i) }, chosen ? `${p.bssid} ✓` : p.bssid);
    return element("tr", {}, element("td", {}, name), number(`${format.metres(p.x)}, ${format.metres(p.y)}`),
      number(`${format.metres(p.major_m)} / ${format.metres(p.minor_m)}`), number(decibels(p.p0_dbm)), number(known(p.exponent) ? d3.format(".2f")(p.exponent) : missing),
      number(decibels(p.sigma_db)), number(format.count(p.readings)), element("td", {}, p.known));
  });
  const heads = ["access point", "position (m)", "1 σ, long / short (m)", "power at 1 m (dBm)", "exponent", "σ (dB)", "readings", ""];
  by_id("points-table").replaceChildren(element("table", {}, element("thead", {}, element("tr", {}, ...heads.map((h, i) => element("th", { scope: "col", class: i > 0 && i < 7 ? "number" : null }, h)))), element("tbody", {}, ...rows)));
}

function write_access_points() {
  if (!points.length) return;
  show("points-section");
  const { placed } = report.access_points;
  by_id("points-controls").append(element("span", {}, "circles around the selected access point's readings"),
    choice("circles", [["law", "by its path loss"], ["free", "in free space"], ["none", "none"]], circles_shown.of, of => { circles_shown.of = of; changes.call("layers"); }));
  const loose = points.filter(p => p.known === "loose").length, parts = [
    `${format.plural(placed, "access point")} received in enough places; ellipses are 1 σ.`,
    "Select one to see the distance circles of its readings: by its estimated path loss, or in free space at 20 dBm transmit power."];
  if (loose) parts.push(`${format.count(loose)} hollow and faint: poorly constrained.`);
  if (points.some(p => p.known === "ambiguous")) parts.push("Ambiguous ones are hollow and connected to the alternative position.");
  if (points.length < placed) parts.push(`${format.count(points.length)} are drawn.`);
  if (points.length > table_rows) parts.push(`The ${table_rows} with the most readings are listed; all are in access_points.csv.`);
  if (points.length > 12) by_id("points-table").classList.add("tall");
  by_id("points-caption").textContent = parts.join(" ");
  write_points_table();
}
