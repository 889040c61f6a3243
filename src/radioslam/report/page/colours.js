// Colours that colour-blind readers can distinguish. Robots: Okabe and Ito's palette for up to six, viridis in
// the robots' order beyond. Closures: by kind, after Tol's muted palette without its reds; rejected ones tend to vermillion.

const dark_scheme = window.matchMedia("(prefers-color-scheme: dark)");
let printing = false;
const is_dark = () => dark_scheme.matches && !printing;

const robot_palette = {
  light: ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00"],
  dark: ["#4aa8e0", "#f0b429", "#22b98d", "#dd8fb9", "#9ad4f5", "#ee8044"],
};
const kind_palette = {
  light: { range: "#117733", aoa: "#999933", fingerprint: "#43359f", sequence: "#44aa99", lidar: "#3d93bd", match: "#5b6168", file: "#5b6168" },
  dark: { range: "#5cb87a", aoa: "#c9c95a", fingerprint: "#a497f5", sequence: "#6fd3c3", lidar: "#7cc4e8", match: "#a7adb3", file: "#a7adb3" },
};
const rejected_colour = { light: "#d55e00", dark: "#ee8044" };

const scheme = () => (is_dark() ? "dark" : "light");

function robot_colour(index) {
  const palette = robot_palette[scheme()];
  if (robots.length <= palette.length) return palette[index];
  const share = index / (robots.length - 1);
  return d3.interpolateViridis(is_dark() ? 0.22 + 0.78 * share : 0.02 + 0.83 * share);
}

function closure_colour(group) {
  const kind = kind_palette[scheme()][group.kind] || "#777777";
  return group.status === "accepted" ? kind : d3.interpolateLab(kind, rejected_colour[scheme()])(0.75);
}

const css = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
