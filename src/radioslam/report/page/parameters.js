// All parameters as used; those that differ from their default are highlighted.

function parameter_row(p) {
  return element("tr", { class: p.changed ? "changed" : null }, element("td", {}, p.key), element("td", { class: "text" }, p.value),
    element("td", {}, p.unit), element("td", { class: "text" }, p.meaning));
}

function write_parameters() {
  const all = report.parameters;
  if (!all.length) return;
  show("parameters-section");
  const changed = all.filter(p => p.changed).length;
  const body = element("tbody", {}), count = element("span", { class: "quiet", role: "status" });
  const search = element("input", { type: "search", placeholder: "Search", "aria-label": "Search parameters", oninput: () => fill() });
  let only_changed = false;
  const fill = () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(w => w);
    const found = all.filter(p => (!only_changed || p.changed) && words.every(w => `${p.key} ${p.value} ${p.meaning}`.toLowerCase().includes(w)));
    body.replaceChildren(...found.map(parameter_row));
    count.textContent = found.length < all.length ? `${found.length} of ${all.length}` : `${all.length} parameters, ${changed || "none"} changed`;
  };
  by_id("parameters-controls").append(search, ...(changed ? [check("changed only", false, on => { only_changed = on; fill(); })] : []), count);
  const heads = ["key", "value", "unit", "description"].map(name => element("th", { scope: "col" }, name));
  const place = by_id("parameters-table");
  if (all.length > 20) place.classList.add("tall");
  place.append(element("table", {}, element("thead", {}, element("tr", {}, ...heads)), body));
  fill();
}
