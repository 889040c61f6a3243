// The table as printed, and its notes.

function write_table() {
  const head = element("tr", {}, element("th", { scope: "col" }, ""), ...study.columns.map(name => element("th", { scope: "col" }, name)));
  const rows = study.rows.map(row => element("tr", {}, element("td", {}, row.label), ...row.cells.map(text => element("td", {}, text))));
  by_id("table").append(element("table", {}, element("thead", {}, head), element("tbody", {}, ...rows)));
  if (rows.length > 30) by_id("table").classList.add("tall");
  by_id("notes-list").append(...study.notes.map(note => element("li", {}, note)));
}
