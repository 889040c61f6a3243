// Figures and tables of the live page.

const event_rows = 200;

function write_table(id, heads, kinds, rows) {
  const line = (tag, cells) => element("tr", {}, ...cells.map((cell, k) => element(tag, { class: kinds[k] }, ...(Array.isArray(cell) ? cell : [cell]))));
  if (!rows.length) return;
  show(`${id}-section`);
  by_id(`${id}-table`).replaceChildren(element("table", {}, element("thead", {}, line("th", heads)), element("tbody", {}, ...rows.map(cells => line("td", cells)))));
}

function bytes(count) {
  if (count < 1000) return `${count} B`;
  const [value, unit] = count < 1e6 ? [count / 1e3, "kB"] : count < 1e9 ? [count / 1e6, "MB"] : [count / 1e9, "GB"];
  return `${d3.format(value < 10 ? ".2f" : value < 100 ? ".1f" : ".0f")(value)} ${unit}`;
}

const marked = robot => [element("span", { class: "swatch", style: { background: robot_colour(robot.index) } }), robot.id];
const metres_or_nothing = value => (known(value) ? `${format.metres(value)} m` : missing);
const total_bytes = (sent, peer) => total(live.sent.filter(of => of.sent === sent && (!peer || of.peer === peer)), of => of.bytes);

function write_team() {
  write_table("team", ["robot", "frame", "keyframes", "path", "σ", "records"], ["id", "text", "number", "number", "number", "number"],
    robots.map(robot => {
      const of = live.team[robot.index] || {};
      return [marked(robot), `of ${robot.frame}`, format.count(robot.keyframes), metres_or_nothing(robot.walked_m), metres_or_nothing(of.sigma_team_m),
        of.said > of.here ? `${format.count(of.here)} of ${format.count(of.said)}` : format.count(of.here)];
    }));
}

function write_peers() {
  const own = live.team[robots.findIndex(robot => robot.id === report.self)];
  write_table("peers", ["peer", "last heard", "knows of this robot", "sent", "received", "refused"], ["id", "text", "number", "number", "number", "text"],
    live.peers.map(peer => [
      [element("span", { class: peer.heard ? "dot heard" : "dot" }), peer.id],
      (known(peer.silent_s) ? (peer.heard ? "now" : `${format.duration(peer.silent_s)} ago`) : "never") + (peer.solves ? "" : ", takes others' solutions"),
      own && own.here ? format.percent(Math.min(1, peer.knows_of_own / own.here)) : missing,
      bytes(total_bytes(true, peer.id)), bytes(total_bytes(false, peer.id)),
      peer.refused.map(of => `${of.what} (${format.count(of.count)})`).join("; ") || "nothing"]));
}

function write_traffic() {
  const rows = d3.groups(live.sent, of => of.peer, of => of.kind).flatMap(([peer, kinds]) => kinds.map(([kind, ways]) => {
    const out = ways.find(of => of.sent), back = ways.find(of => !of.sent), cell = (of, key) => (of ? (key === "bytes" ? bytes(of.bytes) : format.count(of[key])) : missing);
    return [peer, kind.replace("_", " "), cell(out, "messages"), cell(out, "bytes"), cell(out, "lost"), cell(back, "messages"), cell(back, "bytes")];
  }));
  write_table("traffic", ["peer", "kind", "sent", "bytes", "lost", "received", "bytes"], ["id", "text", "number", "number", "number", "number", "number"], rows);
}

let events_written = -1;
function write_events() {
  if (live.events.length === events_written) return;
  events_written = live.events.length;
  write_table("events", ["time", "event"], ["number", "text"], live.events.slice(-event_rows).reverse().map(event => [format.clock(Math.max(0, event.t)), event.what]));
  by_id("events-caption").textContent = live.events.length > event_rows ? `The last ${event_rows} of ${format.count(live.events.length)} events, the newest in front.` : "The newest in front.";
}

function write_figures() {
  const sigma = live.sigmas[live.sigmas.length - 1], known_now = live.known[live.known.length - 1] || {}, figures = [];
  const here = total(live.team, of => of.here), said = total(live.team, of => of.said), own_frame = report.components[0] || [];
  if (known(known_now.error_m)) figures.push(figure("ATE (RMSE)", format.metres(known_now.error_m), "m", `of the largest frame, at ${format.clock(known_now.t)}`));
  if (sigma) figures.push(figure("σ of its own position", format.metres(sigma.sigma_team_m), "m", `within the team, at ${format.clock(sigma.t)}`));
  figures.push(figure("Robots in its frame", format.count(own_frame.length), `of ${robots.length}`, own_frame.slice(0, 6).join(", ")));
  figures.push(figure("Records", format.count(here), "", said > here ? `of ${format.count(said)} in the team` : "all that it has heard of"));
  if (closures_total) figures.push(figure("Closures and links", format.count(total(groups.filter(g => g.status === "accepted"), g => g.count)), `of ${format.count(closures_total)}`, "accepted"));
  figures.push(figure("Sent", bytes(total_bytes(true)), "", `${bytes(total_bytes(false))} received`));
  by_id("headline").replaceChildren(...figures);
  by_id("facts").textContent = [`mission time ${format.clock(Math.max(0, live.t))}`, ...(live.rate === 1 ? [] : [`${d3.format("~g")(live.rate)} times as fast as recorded`]),
    format.plural(robots.length, "robot"), `${format.count(total(robots, robot => robot.keyframes))} keyframes`].join(" · ");
}

function write_live_tables() {
  write_figures();
  write_team();
  write_peers();
  write_traffic();
  write_events();
}
