// The tables as printed, and their notes.

function table_element(table) {
  const head = element("tr", {}, element("th", { scope: "col" }, ""), ...table.columns.map(name => element("th", { scope: "col" }, name)));
  const rows = table.rows.map(row => element("tr", {}, element("td", {}, row.label), ...row.cells.map(text => element("td", {}, text))));
  return element("table", {}, element("thead", {}, head), element("tbody", {}, ...rows));
}

const note_elements = table => table.notes.map(note => element("li", {}, note));

function write_table() {
  by_id("table").append(table_element(study));
  if (study.rows.length > 30) by_id("table").classList.add("tall");
  by_id("notes-list").append(...note_elements(study));
  for (const table of study.further || [])
    by_id("further").append(element("section", {}, element("h2", {}, table.title), element("p", { class: "lead quiet" }, table.lead),
      element("div", { class: "results scroll" }, table_element(table)), element("ul", { class: "notes" }, ...note_elements(table))));
}
