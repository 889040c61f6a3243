// Formatting of numbers and words; elements from text, never from markup.

const missing = "–";
const known = v => v !== null && v !== undefined && isFinite(v);
const grouped = d3.format(",");
const minus = text => text.replace(/^-/, "−");

const format = {
  count: v => (known(v) ? grouped(v) : missing),
  metres(v) {
    if (!known(v)) return missing;
    const size = Math.abs(v);
    return minus(d3.format(size >= 1000 ? ",.0f" : size >= 100 ? ".0f" : size >= 10 ? ".1f" : ".2f")(v));
  },
  seconds(v) {
    if (v < 0.0995) return `${d3.format(v < 0.00995 ? ".2f" : ".1f")(v * 1e3)} ms`;
    if (v < 120) return `${d3.format(v < 9.95 ? ".2f" : ".1f")(v)} s`;
    return format.duration(v);
  },
  stage_seconds: v => `${d3.format(v < 10 ? ".3f" : ",.1f")(v)} s`,
  duration(v) {
    if (!known(v)) return missing;
    const whole = Math.round(v), hours = Math.floor(whole / 3600), rest = d3.format("02d");
    const minutes = Math.floor((whole % 3600) / 60);
    if (hours) return `${hours} h ${rest(minutes)} min`;
    return minutes ? `${minutes} min ${rest(whole % 60)} s` : `${whole} s`;
  },
  clock(v) {
    const rest = d3.format("02d");
    const whole = Math.floor(v), minutes = Math.floor(whole / 60);
    const tenths = d3.format("04.1f")(Math.floor((v % 60) * 10) / 10);
    return minutes < 60 ? `${minutes}:${tenths}` : `${Math.floor(minutes / 60)}:${rest(minutes % 60)}:${rest(whole % 60)}`;
  },
  percent: v => (known(v) ? `${d3.format(v > 0 && v < 0.0995 ? ".1f" : ".0f")(v * 100)} %` : missing),
  fine_percent: v => (known(v) ? `${d3.format(v < 0.001 ? ".1~g" : v < 0.0995 ? ".2f" : ".1f")(v * 100)} %` : missing),
  degrees: v => (known(v) ? minus(d3.format(".3f")((v * 180) / Math.PI)) : missing),
  plural: (n, word, words = `${word}s`) => `${grouped(n)} ${n === 1 ? word : words}`,
};

const shortened = text => (text.length > 24 ? `${text.slice(0, 23)}…` : text);

/// element("td", {class: "number"}, "text", child, ...): strings become text nodes.
function element(name, attributes, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) {
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else if (key === "style") Object.assign(node.style, value);
    else if (value === true) node.setAttribute(key, "");
    else if (value !== false && value !== null) node.setAttribute(key, value);
  }
  node.append(...children);
  return node;
}

const by_id = id => document.getElementById(id);
const show = id => { by_id(id).hidden = false; };
