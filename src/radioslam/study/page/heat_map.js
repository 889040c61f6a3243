// Heat maps of a measure, one per number of false paths.

const tile = { width: 40, height: 30 }, edge = { left: 30, top: 22, bottom: 34, right: 2 };

function describe(c) {
  const line = (name, v, text) => `${name}: ${known(v) ? text(v) : missing}`;
  return [`${c.links} links, ${c.sigma_angle_deg}° noise, ${c.false_paths} false paths`,
    line("error", c.ate_m, v => `${format.metres(v)} m`), line("oracle", c.ate_oracle_m, v => `${format.metres(v)} m`),
    line("ratio", c.ratio, d3.format(".2f")), line("worst ratio", c.worst_ratio, d3.format(".2f")),
    line("recall", c.recall, d3.format(".4f")), line("smallest recall", c.least_recall, d3.format(".4f")),
    line("false pairs rejected", c.false_rejected, d3.format(".4f")),
    line("failed", c.failed, format.percent), line("confidently wrong", c.confidently_wrong, format.percent)].join("\n");
}

function draw_tile(svg, c, measure, x, y) {
  const v = c[measure.key], colour = known(v) ? ramp(measure.bad(v)) : "transparent";
  const group = svg.append("g").attr("transform", `translate(${x},${y})`);
  group.append("title").text(describe(c));
  group.append("rect").attr("width", tile.width).attr("height", tile.height).style("fill", colour);
  group.append("text").attr("x", tile.width / 2).attr("y", tile.height / 2 + 4).attr("text-anchor", "middle")
    .style("fill", known(v) ? text_on(colour) : null).text(known(v) ? compact(measure.text, v) : missing);
}

function draw_panel(parent, measure, paths) {
  const { sigma_angle_deg: sigmas, links } = study.map.axes;
  const width = edge.left + tile.width * sigmas.length + edge.right, height = edge.top + tile.height * links.length + edge.bottom;
  const svg = d3.select(parent).append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("role", "img")
    .attr("aria-label", `${measure.name}, ${paths} false paths`);
  svg.append("text").attr("class", "head").attr("x", edge.left).attr("y", 14).text(`${paths} false path${paths === 1 ? "" : "s"}`);
  const bottom = edge.top + tile.height * links.length;
  links.forEach((count, row) => {
    const y = bottom - tile.height * (row + 1);
    svg.append("text").attr("x", edge.left - 7).attr("y", y + tile.height / 2 + 4).attr("text-anchor", "end").text(count);
    sigmas.forEach((sigma, column) => draw_tile(svg, cells.get(cell_key(sigma, count, paths)), measure, edge.left + tile.width * column, y));
  });
  sigmas.forEach((sigma, column) => svg.append("text").attr("x", edge.left + tile.width * (column + 0.5)).attr("y", bottom + 15)
    .attr("text-anchor", "middle").text(`${sigma}°`));
  svg.append("text").attr("x", edge.left + tile.width * sigmas.length).attr("y", bottom + 30).attr("text-anchor", "end").text("angle noise");
  svg.append("text").attr("x", 0).attr("y", bottom + 15).text("links");
}

function draw_scale(measure) {
  const stops = d3.range(0, 1.01, 0.1).map(s => ramp(s)).join(", ");
  return element("div", { class: "scale" }, measure.ends[0], element("span", { class: "ramp", style: { background: `linear-gradient(to right, ${stops})` } }), measure.ends[1]);
}

function write_maps() {
  show("maps-section");
  by_id("maps").replaceChildren(...measures.map(measure => {
    const panels = element("div", { class: "panels" });
    for (const paths of study.map.axes.false_paths) {
      const panel = element("div", { class: "panel" });
      draw_panel(panel, measure, paths);
      panels.append(panel);
    }
    return element("div", { class: "measure" }, element("h3", {}, measure.name), draw_scale(measure), panels);
  }));
}

/// Extent of the failures, as text.
function map_summary() {
  const all = Array.from(cells.values()), breaks = all.filter(c => c.failed >= 0.5), wrong = all.filter(c => c.confidently_wrong > 0);
  const range = (broken, key) => Array.from(new Set(d3.extent(broken, c => c[key]))).join(" to ");
  const where = broken => (broken.length === 0 ? "" : ` (${range(broken, "links")} links, ${range(broken, "sigma_angle_deg")} degrees, ${range(broken, "false_paths")} false paths)`);
  return `In ${breaks.length} of ${all.length} cells at least half of the towns failed${where(breaks)}; in ${wrong.length} at least one town was confidently wrong${where(wrong)}.`;
}
