// Angles of arrival: the profile of one measurement around its receiver, its peaks, and the transmitter's direction by
// the estimate and the truth. Body frame: forward is up, angles counter-clockwise.

const polar = { size: 460, middle: 230, radius: 172, rim: 190, dot: 9 };
const ghost_text = "cross term of two paths";
const direction_of = { link: 0, place: 0 };

/// Body azimuth to the page: up is 0, left is positive.
const on_page = (azimuth, r) => [polar.middle - r * Math.sin(azimuth), polar.middle - r * Math.cos(azimuth)];
const whole_degrees = v => `${minus(d3.format(".0f")((v * 180) / Math.PI))}°`;
const degrees_1 = v => (known(v) ? minus(d3.format(".1f")((v * 180) / Math.PI)) : missing);
const turned_to = (a, b) => Math.atan2(Math.sin(a - b), Math.cos(a - b));

/// Measurements per receiver and transmitter: [{receiver, transmitter, measured: [...]}].
function links_heard() {
  const links = new Map();
  for (const one of report.aoa_measurements.drawn) {
    const key = JSON.stringify([one.receiver, one.transmitter]);
    if (!links.has(key)) links.set(key, { receiver: one.receiver, transmitter: one.transmitter, measured: [] });
    links.get(key).measured.push(one);
  }
  return [...links.values()];
}

function draw_polar_grid(svg) {
  for (const share of [0.25, 0.5, 0.75])
    svg.append("circle").attr("class", "grid").attr("cx", polar.middle).attr("cy", polar.middle).attr("r", share * polar.radius);
  svg.append("circle").attr("class", "ring").attr("cx", polar.middle).attr("cy", polar.middle).attr("r", polar.radius);
  for (const degrees of d3.range(-150, 181, 30)) {
    const azimuth = (degrees * Math.PI) / 180, [x1, y1] = on_page(azimuth, 14), [x2, y2] = on_page(azimuth, polar.radius);
    svg.append("line").attr("class", "grid").attr("x1", x1).attr("y1", y1).attr("x2", x2).attr("y2", y2);
    const [x, y] = on_page(azimuth, polar.rim + 24);
    svg.append("text").attr("x", x).attr("y", y).attr("dy", "0.33em").attr("text-anchor", "middle").text(degrees === 0 ? "forward" : whole_degrees(azimuth));
  }
}

function draw_ray(svg, name, azimuth) {
  if (!known(azimuth)) return;
  const [x, y] = on_page(azimuth, polar.rim + 8);
  svg.append("line").attr("class", name).attr("x1", polar.middle).attr("y1", polar.middle).attr("x2", x).attr("y2", y);
}

function draw_profile(svg, profile) {
  if (!profile.length) return;
  const points = profile.map((power, k) => on_page(-Math.PI + (2 * Math.PI * k) / profile.length, polar.radius * Math.max(0, power || 0)));
  svg.append("path").attr("class", "power").attr("d", d3.line().curve(d3.curveLinearClosed)(points));
}

/// Peaks on the rim: an arc of one sigma to either side, and a numbered dot; the strongest on top.
function draw_peaks(svg, peaks) {
  peaks.map((peak, i) => [peak, i]).reverse().forEach(([peak, i]) => {
    const kind = peak.ghost ? " ghost" : "", [x, y] = on_page(peak.azimuth_rad, polar.rim);
    const sigma = Math.min(Math.PI, peak.sigma_rad || 0), steps = d3.range(-1, 1.0001, 1 / 16);
    const mark = svg.append("g");
    mark.append("title").text(peak_title(peak));
    mark.append("path").attr("class", `spread${kind}`).attr("d", d3.line()(steps.map(s => on_page(peak.azimuth_rad + s * sigma, polar.rim))));
    mark.append("circle").attr("class", `peak${kind}`).attr("cx", x).attr("cy", y).attr("r", polar.dot);
    mark.append("text").attr("class", peak.ghost ? "outlined" : "inside").attr("x", x).attr("y", y).attr("dy", "0.35em").attr("text-anchor", "middle").text(i + 1);
  });
}

const peak_title = peak => `${degrees_1(peak.azimuth_rad)}° ± ${degrees_1(peak.sigma_rad)}°, ${minus(String(peak.power_db))} dB${peak.ghost ? `, ${ghost_text}` : ""}`;

function draw_direction(one) {
  const svg = d3.create("svg").attr("viewBox", `0 0 ${polar.size} ${polar.size}`).attr("role", "img")
    .attr("aria-label", `Power over direction at receiver ${one.receiver}, transmitter ${one.transmitter}; ${one.peaks.map(peak_title).join("; ")}`);
  draw_polar_grid(svg);
  draw_ray(svg, "truth", one.true_azimuth_rad);
  draw_profile(svg, one.profile);
  draw_ray(svg, "estimate", one.estimated_azimuth_rad);
  svg.append("path").attr("class", "body").attr("d", `M${polar.middle},${polar.middle - 12}l8,21l-8,-5l-8,5Z`);
  draw_peaks(svg, one.peaks);
  by_id("directions-profile").replaceChildren(svg.node());
}

function direction_rows(one) {
  const compared = known(one.true_azimuth_rad) ? one.true_azimuth_rad : one.estimated_azimuth_rad;
  const off = azimuth => (known(compared) && known(azimuth) ? [degrees_1(turned_to(azimuth, compared))] : known(compared) ? [missing] : []);
  const row = (name, azimuth, sigma, power, what) => element("tr", {}, ...[name, degrees_1(azimuth), sigma, power, ...(azimuth === compared ? [""] : off(azimuth))]
    .map((text, i) => element("td", i === 0 ? {} : { class: "number" }, text)), element("td", { class: "what" }, what));
  const rows = one.peaks.map((peak, i) => row(String(i + 1), peak.azimuth_rad, degrees_1(peak.sigma_rad), minus(d3.format(".1f")(peak.power_db)), peak.ghost ? ghost_text : ""));
  if (known(one.estimated_azimuth_rad)) rows.push(row("estimate", one.estimated_azimuth_rad, "", "", ""));
  if (known(one.true_azimuth_rad)) rows.push(row("truth", one.true_azimuth_rad, "", "", ""));
  const heads = ["peak", "azimuth (°)", "σ (°)", "power (dB)", ...(known(compared) ? [`error to ${known(one.true_azimuth_rad) ? "truth" : "estimate"} (°)`] : []), ""];
  return element("table", {}, element("thead", {}, element("tr", {}, ...heads.map((h, i) => element("th", { scope: "col", class: i > 0 && h ? "number" : null }, h)))), element("tbody", {}, ...rows));
}

function direction_key() {
  const { drawn } = report.aoa_measurements;
  const mark = (text, name, shape) => {
    const svg = d3.create("svg").attr("viewBox", "0 0 26 10").attr("aria-hidden", "true");
    shape(svg, name);
    return element("span", { class: "key" }, svg.node(), text);
  };
  const line = (svg, name) => svg.append("line").attr("class", name).attr("x1", 0).attr("x2", 26).attr("y1", 5).attr("y2", 5);
  const dotted = (svg, name) => {
    line(svg, `spread${name}`);
    svg.append("circle").attr("class", `peak${name}`).attr("cx", 13).attr("cy", 5).attr("r", 4.5);
  };
  const key = [mark("received power, relative to the maximum", "power", (svg, name) => svg.append("rect").attr("class", name).attr("y", 1).attr("width", 26).attr("height", 8)),
    mark("peak, ± 1 σ", "", dotted)];
  if (drawn.some(one => one.peaks.some(peak => peak.ghost))) key.push(mark(`${ghost_text}: not a physical direction`, " ghost", dotted));
  if (drawn.some(one => known(one.estimated_azimuth_rad))) key.push(mark("transmitter by the final estimate", "estimate", line));
  if (drawn.some(one => known(one.true_azimuth_rad))) key.push(mark("true direction of the transmitter", "truth", line));
  return key;
}

/// A drop-down list with previous and next buttons; nothing if there is only one option.
function direction_chooser(label, texts, chosen, on_change) {
  if (texts.length < 2) return [];
  const list = element("select", { "aria-label": label, onchange: () => on_change(Number(list.value)) }, ...texts.map((text, i) => element("option", { value: i }, text)));
  list.value = chosen;
  const step = (text, name, by) => element("button", { type: "button", "aria-label": name, onclick: () => on_change((chosen + by + texts.length) % texts.length) }, text);
  return [element("span", { class: "check" }, label, step("‹", `previous ${label}`, -1), list, step("›", `next ${label}`, 1))];
}

function show_direction(links) {
  const { measured, receiver, transmitter } = links[direction_of.link], one = measured[direction_of.place];
  const choose = change => { Object.assign(direction_of, change); show_direction(links); };
  const focused = by_id("directions-controls").contains(document.activeElement) ? document.activeElement.getAttribute("aria-label") : null;
  by_id("directions-controls").replaceChildren(
    ...direction_chooser("link", links.map(l => `${shortened(l.receiver)} from ${shortened(l.transmitter)} (${l.measured.length})`), direction_of.link, link => choose({ link, place: 0 })),
    ...direction_chooser("time", measured.map(m => format.clock(m.t)), direction_of.place, place => choose({ place })));
  if (focused) for (const control of by_id("directions-controls").querySelectorAll("[aria-label]")) if (control.getAttribute("aria-label") === focused) control.focus();
  by_id("directions-name").textContent = `${receiver} receives ${transmitter} at ${format.clock(one.t)}`;
  draw_direction(one);
  by_id("directions-table").replaceChildren(direction_rows(one));
}

function write_directions() {
  if (!report.aoa_measurements || !report.aoa_measurements.drawn.length) return;
  show("directions-section");
  const { measured, drawn } = report.aoa_measurements;
  by_id("directions-key").append(...direction_key());
  by_id("directions-caption").textContent = "Seen from above in the receiver's body frame: forward is up, angles counter-clockwise; the radius of the profile is its power."
    + (drawn.length < measured ? ` ${format.count(drawn.length)} of ${format.plural(measured, "measurement")} are on this page, evenly spaced; all are in aoa.csv.` : ` ${format.plural(measured, "measurement")}.`);
  show_direction(links_heard());
}
