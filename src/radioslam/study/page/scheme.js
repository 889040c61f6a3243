// One ramp from good to bad for every measure: pale to vermillion to brown, turned around on dark paper.

const dark_scheme = window.matchMedia("(prefers-color-scheme: dark)");
const ramps = {
  light: d3.interpolateRgbBasis(["#eef3f1", "#f6d9a8", "#e8883a", "#a53c06", "#571a02"]),
  dark: d3.interpolateRgbBasis(["#1d2729", "#5a3b14", "#b45f1c", "#f0a05c", "#ffe0c2"]),
};
const ramp = share => ramps[dark_scheme.matches ? "dark" : "light"](Math.max(0, Math.min(1, share)));

/// Black or white, whichever stands out.
function text_on(colour) {
  const { r, g, b } = d3.rgb(colour);
  return 0.299 * r + 0.587 * g + 0.114 * b > 140 ? "#1b1d1f" : "#ffffff";
}

// How bad a value is, from 0 to 1, and what the ends of the ramp say.
const worst_ratio = 10, worst_recall = 0.5;
const measures = [
  { key: "ratio", name: "Error over the oracle's, median", bad: v => Math.log(Math.max(v, 1)) / Math.log(worst_ratio), text: d3.format(".2f"), ends: ["1", `${worst_ratio} and more`] },
  { key: "worst_ratio", name: "Error over the oracle's, worst town", bad: v => Math.log(Math.max(v, 1)) / Math.log(worst_ratio), text: d3.format(".2f"), ends: ["1", `${worst_ratio} and more`] },
  { key: "recall", name: "Recall of the pairs whose views overlap, median", bad: v => (1 - v) / (1 - worst_recall), text: d3.format(".3f"), ends: ["1", `${worst_recall} and less`] },
  { key: "least_recall", name: "Recall, worst town", bad: v => (1 - v) / (1 - worst_recall), text: d3.format(".3f"), ends: ["1", `${worst_recall} and less`] },
  { key: "false_rejected", name: "False pairs rejected, median", bad: v => (1 - v) / (1 - worst_recall), text: d3.format(".3f"), ends: ["1", `${worst_recall} and less`] },
  { key: "failed", name: "Share of towns that failed", bad: v => v, text: d3.format(".2~f"), ends: ["0", "1"] },
  { key: "confidently_wrong", name: "Share of towns confidently wrong", bad: v => v, text: d3.format(".2~f"), ends: ["0", "1"] },
];
const compact = (text, v) => (Math.abs(v) >= 100 ? d3.format(".0f")(v) : Math.abs(v) >= 10 ? d3.format(".1f")(v) : text(v));
