// Panel beside the map: selects layers, closures and robots.

function swatch(draw) {
  const svg = d3.create("svg").attr("viewBox", "0 0 26 10").attr("aria-hidden", "true");
  draw(svg.append("line").attr("x1", 0).attr("x2", 26).attr("y1", 5).attr("y2", 5));
  return svg.node();
}

function row(text, value, sample, checked, on_change, disabled = false) {
  const box = element("input", { type: "checkbox", ...(checked ? { checked: true } : {}), ...(disabled ? { disabled: true } : {}), onchange: () => on_change(box.checked) });
  return element("label", { class: "row", title: text }, box, sample, element("span", { class: "name" }, text), element("span", { class: "value" }, value));
}

function group_of_rows(title, ...children) {
  return element("fieldset", {}, element("legend", {}, title), ...children);
}

function layer_rows() {
  const layer = (key, text, sample) => row(text, "", swatch(sample), state.layers[key], on => { state.layers[key] = on; changes.call("layers"); });
  const ink = css("ink"), rows = [layer("estimate", "estimate", line => line.attr("stroke", ink).attr("stroke-width", 2))];
  if (robots.some(r => r.odometry))
    rows.push(layer("odometry", "odometry only", line => line.attr("stroke", ink).attr("stroke-width", 1.1).attr("stroke-dasharray", "5 4")));
  if (robots.some(r => r.truth)) rows.push(layer("truth", "truth", line => line.attr("stroke", css("truth")).attr("stroke-width", 3.5)));
  if (robots.some(r => r.sigma_team_m))
    rows.push(layer("sigma", "1 σ within the team", line => line.attr("stroke", ink).attr("stroke-width", 9).attr("stroke-opacity", 0.16)));
  if (has_grid) rows.push(layer("grid", "occupancy grid", line => line.attr("stroke", css("walls")).attr("stroke-width", 8)));
  if (cloud.count) rows.push(layer("points", "points", line => line.attr("stroke", robot_colour(cloud.robot[0])).attr("stroke-width", 3).attr("stroke-dasharray", "1.5 2.5")));
  if (alternatives.length)
    rows.push(layer("alternatives", format.plural(alternatives.length, "other hypothesis", "other hypotheses"),
      line => line.attr("stroke", ink).attr("stroke-width", 1.6).attr("stroke-dasharray", "1 3").attr("stroke-linecap", "round")));
  if (points_placed)
    rows.push(layer("access_points", format.plural(points_placed, "access point"), line => line.attr("stroke", ink).attr("stroke-width", 8).attr("x1", 9).attr("x2", 17)));
  return rows;
}

function closure_rows() {
  return groups.map((group, g) => row(`${group.kind}, ${group.status}`, format.count(group.count),
    swatch(line => line.attr("stroke", closure_colour(group)).attr("stroke-width", 1.4)), state.groups[g],
    on => { state.groups[g] = on; changes.call("layers"); }));
}

function robot_row(robot) {
  const value = robot.ate ? `${format.metres(robot.ate.rmse_m)} m` : robot.stranded ? "unplaced" : "";
  const sample = swatch(line => line.attr("stroke", robot_colour(robot.index)).attr("stroke-width", 3));
  const line = row(robot.id, value, sample, state.visible[robot.index], on => {
    state.visible[robot.index] = on;
    changes.call("visibility");
  });
  line.addEventListener("mouseenter", () => highlight(robot.index));
  line.addEventListener("mouseleave", () => highlight(null));
  line.addEventListener("focusin", () => highlight(robot.index));
  line.addEventListener("focusout", () => highlight(null));
  return line;
}

function show_only(chosen) {
  state.visible = robots.map(chosen);
  changes.call("visibility");
}

function component_chooser(map) {
  if (report.components.length < 2) return [];
  const options = report.components.map((ids, c) => element("option", { value: c, selected: c === state.frame },
    `frame ${c + 1}: ${ids.length > 3 ? `${ids.slice(0, 2).join(", ")} and ${ids.length - 2} more` : ids.join(", ")}`));
  return [element("select", { "aria-label": "Frame shown", onchange: event => {
    state.frame = Number(event.target.value);
    show_only(robot => robot.component === state.frame);
    map.fit();
  } }, ...options)];
}

/// The planes, and space where the browser draws it.
function view_rows(map) {
  const planes = { xy: ["x", "y"], xz: ["x", "z"], yz: ["y", "z"] };
  const views = [["xy", "from above"]];
  if (report.dimension === 3) views.push(["xz", "x–z"], ["yz", "y–z"]);
  if (has_webgl && (cloud.count || report.dimension === 3)) views.push(["space", "3D"]);
  if (views.length === 1 && !cloud.count) return [];
  const set = name => {
    if (name !== "space") state.axes = planes[name];
    else if (cloud.count && !state.layers.points) state.layers.points = true;
    map.set_space(name === "space");
    changes.call("layers");
    changes.call("theme");
  };
  const shown_now = map.in_space ? "space" : state.axes.join("");
  const rows = [choice("view", views, shown_now, set)];
  if (cloud.count) rows.push(...point_rows(map));
  return [group_of_rows("View", ...rows)];
}

/// What colours the points, and sliders for their height and for time.
function point_rows(map) {
  const colours = [["robot", "robot"], ...(has_heights ? [["height", "height"]] : []), ["time", "time"]];
  const rows = [element("div", { class: "setting" }, "Points by ", choice("points by", colours, state.colour, value => {
    state.colour = value;
    if (!state.layers.points) state.layers.points = true;
    changes.call("colour");
    changes.call("layers");
    changes.call("theme");
  }))];
  if (alternatives.length) rows.push(element("div", { class: "setting" }, "Team of ", element("select", { "aria-label": "Hypothesis whose points and trajectories are shown",
    onchange: event => {
      state.hypothesis = event.target.value === "shown" ? "shown" : Number(event.target.value);
      if (!state.layers.points) state.layers.points = true;
      changes.call("layers");
      changes.call("theme");
      map.fit();
    } }, ...["shown", ...d3.range(alternatives.length)].map(k => element("option", { value: k, selected: k === state.hypothesis },
    k === "shown" ? `team shown, ${d3.format(".2f")(report.weight)}` : `hypothesis ${k + 1}, ${d3.format(".2f")(alternatives[k].weight)}`)))));
  if (has_heights) rows.push(slider("up to height", height_span, "top", v => `${format.metres(v)} m`));
  rows.push(slider("up to time", [0, time_end], "until", format.clock));
  return rows;
}

/// A limit; at its right end there is none.
function slider(name, [low, high], key, text) {
  const value = element("output", { class: "value" });
  const write = () => { value.textContent = isFinite(state[key]) ? text(state[key]) : "all"; };
  const input = element("input", { type: "range", min: 0, max: 1000, "aria-label": name,
    value: isFinite(state[key]) ? Math.round((1000 * (state[key] - low)) / (high - low)) : 1000,
    oninput: () => {
      state[key] = Number(input.value) === 1000 ? Infinity : low + ((high - low) * input.value) / 1000;
      write();
      changes.call("limits");
    } });
  write();
  return element("label", { class: "slider" }, element("span", {}, name), input, value);
}

function draw_panel(panel, map) {
  const button = (text, action) => element("button", { type: "button", class: "plain", onclick: action }, text);
  const list = element("div", { class: "robot-list" });
  const list_robots = () => group_of_rows(robots.some(r => r.ate) ? "Robots, ATE RMSE" : "Robots", ...component_chooser(map),
    ...(robots.length > 1 ? [element("div", { class: "panel-buttons" }, button("all", () => show_only(() => true)), button("none", () => show_only(() => false)))] : []), list);
  const fill = () => {
    const focused = list.contains(document.activeElement) ? [...list.querySelectorAll("input")].indexOf(document.activeElement) : -1;
    list.replaceChildren(...robots.map(robot_row));
    if (focused >= 0) list.querySelectorAll("input")[focused].focus();
  };
  const build = () => {
    const who = list_robots();
    who.className = "robots";
    panel.replaceChildren(...view_rows(map), group_of_rows("Layers", ...layer_rows()),
      ...(groups.length ? [group_of_rows("Closures", ...closure_rows())] : []), who);
    fill();
  };
  changes.on("visibility.panel", fill);
  changes.on("theme.panel", build);
  changes.on("structure.panel", build);
  build();
}

function caption_map() {
  const parts = [];
  if (report.frame === "truth") parts.push("In the truth's frame, after one rigid alignment of the whole team.");
  else if (report.components.length < 2) parts.push("In the team's own frame.");
  if (report.components.length > 1)
    parts.push(`The team has ${report.components.length} components; no measurement connects their frames.`);
  if (robots.length <= few_robots) parts.push("A ring marks a robot's start.");
  if (alternatives.length) parts.push("Dotted: the other hypotheses, aligned at the first robot; one that is chosen is drawn with its points, as each robot's are moved rigidly.");
  if (closures_drawn < closures_total)
    parts.push(`${format.count(closures_drawn)} of ${format.count(closures_total)} closures are drawn, evenly spaced within each kind and status; all are counted.`);
  const scans = total(report.maps, map => map.scans), all = total(report.maps, map => map.all_points), through = total(report.maps, map => map.seen_through);
  if (has_grid) parts.push(`Grid, from ${format.plural(scans, "scan")}: dark cells are occupied, light ones free, the others unknown; only in the view from above.`);
  if (cloud.count < all) parts.push(`${format.count(cloud.count)} of the map's ${format.count(all)} points are drawn; map.ply has all.`);
  if (through) parts.push(`${format.plural(through, "point")} of things that moved, through which other scans look, ${through === 1 ? "is" : "are"} left out.`);
  const drawn = total(robots, r => (r.estimate ? r.estimate.t.length : 0)), keyframes = total(robots, r => r.keyframes);
  if (drawn < keyframes) parts.push(`${format.count(drawn)} of ${format.count(keyframes)} keyframes are drawn.`);
  by_id("map-caption").textContent = parts.join(" ");
}

function write_map() {
  if (!robots.some(robot => robot.estimate || robot.truth)) return;
  show("map-section");
  const map = new MapView(by_id("map-canvas"));
  draw_panel(by_id("map-panel"), map);
  caption_map();
}
