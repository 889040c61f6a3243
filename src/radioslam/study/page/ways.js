// Trajectories of the team by every way of running, over the true ones.

const plan = { width: 340, height: 320, margin: 14 };

function draw_way(run, extent) {
  const [[left, right], [low, high]] = extent, inner = 2 * plan.margin;
  const scale = Math.min((plan.width - inner) / (right - left), (plan.height - inner - 24) / (high - low));
  const at = ([x, y]) => [plan.margin + scale * (x - left), plan.margin + scale * (high - y)];
  const line = d3.line().x(p => at(p)[0]).y(p => at(p)[1]);
  const error = known(run.ate_m) ? `${d3.format(".3~g")(run.ate_m)} m` : "robots in several frames";
  const svg = d3.create("svg").attr("viewBox", `0 0 ${plan.width} ${plan.height}`).attr("role", "img").attr("aria-label", `${run.name}: ${error}`);
  for (const robot of run.robots) svg.append("path").attr("class", "truth").attr("d", line(robot.truth));
  run.robots.forEach((robot, k) => svg.append("path").attr("d", line(robot.estimate)).style("stroke", `var(--method-${k % 6})`).append("title").text(robot.robot));
  const bar = 10 ** Math.floor(Math.log10((right - left) / 2)), foot = plan.height - 8;
  svg.append("line").attr("x1", plan.margin).attr("x2", plan.margin + scale * bar).attr("y1", foot).attr("y2", foot);
  svg.append("text").attr("x", plan.margin + scale * bar + 6).attr("y", foot + 4).text(`${d3.format(",")(bar)} m`);
  return element("div", { class: "panel" }, svg.node(), element("p", { class: "caption" }, `${run.name}: ${error}`));
}

function write_ways() {
  show("ways-section");
  const { seed, runs } = study.ways;
  const points = runs.flatMap(run => run.robots.flatMap(robot => robot.truth.concat(robot.estimate)));
  const extent = [0, 1].map(k => d3.extent(points, p => p[k]));
  const entry = (text, style) => {
    const item = d3.select(by_id("ways-key")).append("span"), path = item.append("svg").attr("viewBox", "0 0 30 10").append("path").attr("d", "M0 5H30");
    if (style) path.style("stroke", style).style("stroke-width", 2); else path.attr("class", "truth");
    item.append("span").text(text);
  };
  entry("truth");
  runs[0].robots.forEach((robot, k) => entry(robot.robot, `var(--method-${k % 6})`));
  by_id("ways").replaceChildren(...runs.map(run => draw_way(run, extent)));
  by_id("ways-caption").textContent = `Seed ${seed}, with the defaults. The team is aligned with the truth as a whole; robots in several frames are aligned each by itself.`;
}
