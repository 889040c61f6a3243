// Agents of a team: what each knew over time, the error of its estimate, what was sent, and what happened.

const agent_rows = 200;

function agent_chart(host, agents, value, label, y_label) {
  const series = agents.map(([name, points]) => [name, points.filter(p => known(value(p)))]).filter(([, points]) => points.length > 0);
  const all = series.flatMap(([, points]) => points);
  if (all.length === 0) return;
  new Chart(host, {
    height: 240, label, x_label: () => "time (min:s)", y_label: () => y_label,
    ticks_x: clock_ticks, format_x: clock_label, ticks_y: y => y.ticks(5), format_y: d3.format("~g"),
    scales: (width, height) => ({
      x: d3.scaleLinear().domain([Math.min(0, d3.min(all, p => p.t)), d3.max(all, p => p.t) || 1]).range([0, width]),
      y: d3.scaleLinear().domain([0, 1.05 * (d3.max(all, value) || 1)]).range([height, 0]),
    }),
    draw(context, x, y) {
      series.forEach(([name, points]) => {
        context.strokeStyle = robot_colour(report.robots.findIndex(r => r.id === name));
        context.lineWidth = 1.5;
        context.beginPath();
        trace(context, points.map(p => p.t), points.map(value), x, y);
        context.stroke();
      });
    },
  });
}

function write_agents() {
  if (!report.agents) return;
  show("agents-section");
  const { known: points, sent, events } = report.agents, agents = d3.groups(points, p => p.agent);
  agent_chart(by_id("agents-error"), agents, p => p.error_m, "Error of each agent's estimate as it was known, over time", "error (m)");
  agent_chart(by_id("agents-share"), agents, p => 100 * p.share, "Share of the team's records that each agent had, over time", "known (%)");
  const row = (tag, cells, kinds) => element("tr", {}, ...cells.map((c, k) => element(tag, { class: kinds[k] }, c)));
  const kinds = ["text", "number", "number", "number"], count = d3.format(",");
  by_id("agents-sent").append(element("table", {},
    element("thead", {}, row("th", ["messages", "sent", "bytes", "lost"], kinds)),
    element("tbody", {}, ...sent.map(s => row("td", [s.kind, count(s.messages), count(s.bytes), count(s.lost)], kinds)))));
  by_id("agents-events").append(element("table", {}, element("tbody", {}, ...events.slice(0, agent_rows).map(e =>
    element("tr", {}, element("td", { class: "number" }, format.clock(e.t)), element("td", { class: "text" }, e.what))))));
  by_id("agents-caption").textContent = "Each line is a robot's agent, in the robot's colour. Above: error of the largest frame that it knew, as far as it was known then. Below: share of what all robots had said by then."
    + (events.length > agent_rows ? ` The first ${agent_rows} of ${events.length} events.` : "");
}
