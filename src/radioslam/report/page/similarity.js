// Distance over fingerprint similarity: the samples, and the fitted mean with one sigma.

function draw_samples(context, x, y, samples) {
  context.fillStyle = css("accent");
  context.globalAlpha = Math.max(0.08, Math.min(0.5, 16 / Math.sqrt(1 + samples.similarity.length)));
  const size = samples.similarity.length > 2000 ? 2 : 3;
  for (let i = 0; i < samples.similarity.length; ++i)
    context.fillRect(x(samples.similarity[i]) - size / 2, y(samples.distance_m[i]) - size / 2, size, size);
  context.globalAlpha = 1;
}

function draw_model(context, x, y, bins) {
  if (!bins.length) return;
  const low = b => y(Math.max(0, b.distance_m - b.sigma_m)), high = b => y(b.distance_m + b.sigma_m);
  context.fillStyle = "#e69f00";
  context.globalAlpha = 0.22;
  context.beginPath();
  bins.forEach(b => context.lineTo(x(b.similarity), high(b)));
  [...bins].reverse().forEach(b => context.lineTo(x(b.similarity), low(b)));
  context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = css("ink");
  context.lineWidth = 2;
  context.beginPath();
  bins.forEach(b => context.lineTo(x(b.similarity), y(b.distance_m)));
  context.stroke();
  context.fillStyle = css("ink");
  for (const b of bins) {
    context.beginPath();
    context.arc(x(b.similarity), y(b.distance_m), 2.5, 0, 2 * Math.PI);
    context.fill();
  }
}

function write_similarity() {
  const model = report.similarity;
  if (!model || (!model.bins.length && !model.samples)) return;
  show("similarity-section");
  const bins = model.bins.filter(b => known(b.distance_m) && known(b.sigma_m)), { drawn } = model;
  new Chart(by_id("similarity-chart"), {
    height: 340, label: "Distance of training pairs over their similarity, with the fitted model",
    x_label: () => `similarity (${shortened(model.measure)})`, y_label: () => "distance along the odometry (m)",
    scales(width, height) {
      const all = drawn.similarity.concat(bins.map(b => b.similarity));
      const tops = drawn.distance_m.concat(bins.map(b => b.distance_m + b.sigma_m));
      return {
        x: d3.scaleLinear().domain([Math.min(0, d3.min(all)), Math.max(1e-6, d3.max(all))]).nice().range([0, width]),
        y: d3.scaleLinear().domain([0, (d3.max(tops) || 1) * 1.03]).range([height, 0]),
      };
    },
    draw(context, x, y) { draw_samples(context, x, y, drawn); draw_model(context, x, y, bins); },
  });
  const thinned = drawn.similarity.length < model.samples ? `, ${format.count(drawn.similarity.length)} of them drawn` : "";
  by_id("similarity-caption").textContent = `${format.count(model.samples)} pairs of fingerprints, each of a single robot${thinned}.`
    + (bins.length ? " Line: fitted mean per bin; band: one σ to either side." : " Too few for a fitted model.");
}
