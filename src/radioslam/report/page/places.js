// From pairs to closures: how many pairs of keyframes each step of place recognition with scans leaves.

function place_steps(places) {
  const steps = [["pairs of keyframes", places.pairs], ["left by pruning", places.allowed], ["descriptors compared", places.compared],
    ["scans registered", places.registered], ["verified by their fit", places.verified], ["accepted by the joint estimate", places.accepted]]
    .map(([name, count], k, all) => ({ name, count, of: k ? all[k - 1][1] : null, colour: "bar" }));
  if (!known(places.true) || !places.accepted) return steps;
  const part = (name, count, colour) => ({ name, count, of: places.accepted, colour, part: true });
  const not_covered = places.accepted - places.true - places.false;
  return [...steps, part("true", places.true, "accepted"), part("false", places.false, "rejected"), ...(not_covered ? [part("not covered by the truth", not_covered, "bar")] : [])];
}

function write_places() {
  const { places } = report;
  if (!places) return;
  show("places-section");
  const steps = place_steps(places), longest = Math.log1p(Math.max(...steps.map(s => s.count)));
  const bar = s => element("span", { class: "bar", style: { width: `${(100 * Math.log1p(s.count)) / longest}%`, background: s.count ? `var(--${s.colour})` : "none" } });
  const rows = steps.flatMap(s => [element("span", { class: s.part ? "name part" : "name" }, s.name), bar(s),
    element("span", { class: "number" }, format.count(s.count)), element("span", { class: "number" }, s.of === null ? "" : format.fine_percent(s.count / s.of))]);
  const heads = ["", "", "count", "of the step before"].map(text => element("span", { class: "number quiet" }, text));
  by_id("places-steps").append(element("div", { class: "stages funnel" }, ...heads, ...rows));
  const parts = ["Keyframes of different robots with scans; bar lengths are logarithmic.",
    "Pruning leaves pairs whose views could overlap; of one robot of each pair, one keyframe per stride of path counts.",
    "Comparisons and registrations are those of all rounds."];
  if (known(places.true)) parts.push("True: within 0.5 m and 5° of the true relative pose.");
  by_id("places-caption").textContent = parts.join(" ");
}
