// Hypotheses of the team alignment: their weights, and their errors if the truth is known.

function write_hypotheses() {
  if (!alternatives.length) return;
  show("hypotheses-section");
  const has_truth = Boolean(report.accuracy), longest = Math.max(report.weight, ...alternatives.map(other => other.weight));
  const all = [{ weight: report.weight, ate: has_truth ? report.accuracy.ate.rmse_m : null, name: "shown" },
    ...alternatives.map((other, k) => ({ weight: other.weight, ate: other.ate_rmse_m, name: `hypotheses/${k + 1}` }))];
  const heads = ["team", "weight", ...(has_truth ? ["ATE RMSE (m)"] : [])];
  const line = h => element("tr", {}, element("td", {}, h.name),
    element("td", {}, d3.format(".3f")(h.weight), element("span", { class: "weight", style: { width: `${(160 * h.weight) / longest}px` } })),
    ...(has_truth ? [element("td", {}, format.metres(h.ate))] : []));
  by_id("hypotheses-table").append(element("table", {}, element("thead", {}, element("tr", {}, ...heads.map(h => element("th", { scope: "col" }, h)))),
    element("tbody", {}, ...all.map(line))));
  by_id("hypotheses-caption").textContent = "Weights are the probabilities of the alignments given the links. Pairs and closures below belong to the hypothesis shown.";
}
