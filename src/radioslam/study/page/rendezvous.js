// A study of rendezvous: its charts, and replays of runs with a time slider, a map and the robots' errors over time.

const player = { replay: null, at: 0, layer: null, svg: null, cursor: null, x: null, timer: null };
const play = { longest_ms: 150, whole_ms: 30000 };  // per iteration; a run takes at most so long

function moment_rows(replay, now) {
  const name = k => short_name(replay.robots[k]), everyone = d3.range(replay.robots.length);
  const listed = words => words.join(", ") || "nobody";
  const offsets = everyone.map(k => Math.hypot(now.truth[k][0] - now.estimate[k][0], now.truth[k][1] - now.estimate[k][1])).filter(known);
  return [["Asks", listed(everyone.filter(k => now.asking[k]).map(name))],
    ["Walks to another", listed(everyone.filter(k => now.serving[k] >= 0).map(k => `${name(k)} to ${name(now.serving[k])}`))],
    ["Meets another", listed(everyone.filter(k => now.seeing[k]).map(name))],
    ["Mean true error", `${format.metres(d3.mean(offsets))} m`]];
}

function show_moment(at) {
  const { replay } = player, last = replay.iterations.length - 1;
  player.at = Math.max(0, Math.min(last, at));
  const now = replay.iterations[player.at], text = `iteration ${player.at + 1} of ${last + 1}`;
  by_id("replay-time").value = player.at + 1;
  by_id("replay-time").setAttribute("aria-valuetext", text);
  by_id("replay-now").textContent = text;
  draw_moment(player.layer, replay, player.at);
  player.cursor.attr("x1", player.x(player.at + 1)).attr("x2", player.x(player.at + 1));
  const rows = moment_rows(replay, now);
  player.svg.attr("aria-label", `${replay.name}, ${text}. ${rows.map(([term, words]) => `${term}: ${words}`).join(". ")}`);
  by_id("replay-moment").replaceChildren(...rows.flatMap(([term, words]) => [element("dt", {}, term), element("dd", {}, words)]));
}

function draw_errors(replay) {
  const robots = replay.robots.map((name, k) => ({ name: short_name(name), colour: robot_colour(k, replay.robots.length), points: replay.iterations.map((moment, i) => [i + 1, moment.error[k]]) }));
  const chart = { title: replay.name, x: "iteration", y: "error, as each robot sees its own", threshold: replay.delta, series: robots };
  const parent = by_id("replay-errors"), { svg, x } = draw_lines(parent, chart);
  if (robots.length <= labelled_robots) write_key(parent, chart, false);
  player.x = x;
  player.cursor = svg.append("line").attr("class", "cursor").attr("y1", plot.top).attr("y2", plot.height - plot.bottom);
  const jump = () => { pause(); show_moment(Math.round(x.invert(d3.event.x)) - 1); };
  svg.call(d3.drag().container(svg.node()).on("start drag", jump));
}

function pause() {
  if (player.timer) player.timer.stop();
  player.timer = null;
  by_id("replay-play").textContent = "Play";
}

function toggle() {
  if (player.timer) return pause();
  const count = player.replay.iterations.length;
  if (player.at === count - 1) show_moment(0);
  by_id("replay-play").textContent = "Pause";
  player.timer = d3.interval(() => {
    show_moment(player.at + 1);
    if (player.at === count - 1) pause();
  }, Math.min(play.longest_ms, play.whole_ms / count));
}

function choose_replay(replay, at) {
  pause();
  by_id("replay-map").replaceChildren();
  by_id("replay-errors").replaceChildren();
  player.replay = replay;
  player.svg = draw_ground(by_id("replay-map"), replay);
  player.layer = player.svg.append("g");
  by_id("replay-time").max = replay.iterations.length;
  draw_errors(replay);
  show_moment(at);
}

function on_arrow(event) {
  const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  if (!step || ["INPUT", "SELECT"].includes(event.target.tagName)) return;  // they have arrows of their own
  event.preventDefault();
  pause();
  show_moment(player.at + step);
}

function write_replays(replays) {
  show("replay-section");
  const choice = by_id("replay-choice"), slider = by_id("replay-time");
  choice.append(...replays.map((replay, k) => element("option", { value: k }, replay.name)));
  choice.addEventListener("change", () => choose_replay(replays[choice.value], 0));
  slider.addEventListener("input", () => { pause(); show_moment(Number(slider.value) - 1); });
  by_id("replay-play").addEventListener("click", toggle);
  by_id("replay-section").addEventListener("keydown", on_arrow);
  dark_scheme.addEventListener("change", () => choose_replay(player.replay, player.at));
  write_map_key(by_id("replay-key"));
  choose_replay(replays[0], 0);
}

function write_rendezvous() {
  const { charts, replays } = study.rendezvous;
  if (charts.length) show("rendezvous-section");
  charts.forEach(write_chart);
  if (replays.length) write_replays(replays);
}
