// Angles of arrival, one small polar profile per link: power over azimuth, the peaks, the true and the authors' direction.
// Frame of the trajectories: x to the right, angles counter-clockwise.

const rose = { size: 220, middle: 110, radius: 84, rim: 92 };
const rose_at = (azimuth, r) => [rose.middle + r * Math.cos(azimuth), rose.middle - r * Math.sin(azimuth)];
const rose_degrees = v => `${d3.format(".1f")((v * 180) / Math.PI)}°`;

function draw_rose_ray(svg, name, azimuth) {
  const [x, y] = rose_at(azimuth, rose.rim + 12);
  svg.append("line").attr("class", name).attr("x1", rose.middle).attr("y1", rose.middle).attr("x2", x).attr("y2", y);
}

function rose_title(link) {
  const theirs = link.authors_azimuth_rad.length ? `, authors ${rose_degrees(link.authors_azimuth_rad[0])}` : "";
  const measured = link.peaks.length ? `measured ${rose_degrees(link.peaks[0].azimuth_rad)}` : link.reason;
  return `${link.trial}, ${link.transmitter}: truth ${rose_degrees(link.true_azimuth_rad)}, ${measured}${theirs}`;
}

function draw_rose(link) {
  const svg = d3.create("svg").attr("viewBox", `0 0 ${rose.size} ${rose.size}`).attr("role", "img").attr("aria-label", rose_title(link));
  svg.append("title").text(rose_title(link));
  for (const ratio of [0.5, 1]) svg.append("circle").attr("class", "grid").attr("cx", rose.middle).attr("cy", rose.middle).attr("r", ratio * rose.radius);
  draw_rose_ray(svg, "truth", link.true_azimuth_rad);
  if (link.authors_azimuth_rad.length) draw_rose_ray(svg, "authors", link.authors_azimuth_rad[0]);
  const points = link.profile.map((power, k) => rose_at(-Math.PI + (2 * Math.PI * k) / link.profile.length, rose.radius * power));
  svg.append("path").attr("class", "power").attr("d", d3.line().curve(d3.curveLinearClosed)(points));
  link.peaks.forEach((peak, i) => {
    const [x, y] = rose_at(peak.azimuth_rad, rose.rim);
    svg.append("circle").attr("class", i === 0 ? "strongest" : "peak").attr("cx", x).attr("cy", y).attr("r", i === 0 ? 5 : 3);
  });
  return svg.node();
}

function write_directions() {
  show("directions-section");
  const groups = d3.group(study.directions, link => `${link.sight}, ${link.motion}`);
  by_id("directions").replaceChildren(...Array.from(groups, ([name, links]) => element("div", { class: "measure" }, element("h3", {}, name),
    element("div", { class: "panels" }, ...links.map(link => element("div", { class: "panel" }, draw_rose(link), element("p", { class: "caption" }, `${link.trial}, ${link.transmitter}`)))))));
}
