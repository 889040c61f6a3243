// One colour ramp from good to bad for all measures: pale to vermillion to brown, reversed in the dark scheme.

const dark_scheme = window.matchMedia("(prefers-color-scheme: dark)");
const ramps = {
  light: d3.interpolateRgbBasis(["#eef3f1", "#f6d9a8", "#e8883a", "#a53c06", "#571a02"]),
  dark: d3.interpolateRgbBasis(["#1d2729", "#5a3b14", "#b45f1c", "#f0a05c", "#ffe0c2"]),
};
const ramp = badness => ramps[dark_scheme.matches ? "dark" : "light"](Math.max(0, Math.min(1, badness)));

/// Black or white, whichever has more contrast.
function text_on(colour) {
  const { r, g, b } = d3.rgb(colour);
  return 0.299 * r + 0.587 * g + 0.114 * b > 140 ? "#1b1d1f" : "#ffffff";
}

// Badness of a value from 0 to 1, and the labels at the ends of the ramp.
const worst_ratio = 10, worst_recall = 0.5;
const measures = [
  { key: "ratio", name: "Error relative to the oracle's, median", bad: v => Math.log(Math.max(v, 1)) / Math.log(worst_ratio), text: d3.format(".2f"), ends: ["1", `${worst_ratio} or more`] },
  { key: "worst_ratio", name: "Error relative to the oracle's, worst town", bad: v => Math.log(Math.max(v, 1)) / Math.log(worst_ratio), text: d3.format(".2f"), ends: ["1", `${worst_ratio} or more`] },
  { key: "recall", name: "Recall of pairs with overlapping views, median", bad: v => (1 - v) / (1 - worst_recall), text: d3.format(".3f"), ends: ["1", `${worst_recall} or less`] },
  { key: "least_recall", name: "Recall, worst town", bad: v => (1 - v) / (1 - worst_recall), text: d3.format(".3f"), ends: ["1", `${worst_recall} or less`] },
  { key: "false_rejected", name: "False pairs rejected, median", bad: v => (1 - v) / (1 - worst_recall), text: d3.format(".3f"), ends: ["1", `${worst_recall} or less`] },
  { key: "failed", name: "Ratio of failed towns", bad: v => v, text: d3.format(".2~f"), ends: ["0", "1"] },
  { key: "confidently_wrong", name: "Ratio of confidently wrong towns", bad: v => v, text: d3.format(".2~f"), ends: ["0", "1"] },
];
const compact = (text, v) => (Math.abs(v) >= 100 ? d3.format(".0f")(v) : Math.abs(v) >= 10 ? d3.format(".1f")(v) : text(v));
