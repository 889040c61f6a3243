// Builds the page.

document.title = `${study.title} · radioslam`;
by_id("title").textContent = study.title;
by_id("lead").textContent = study.lead;
if (study.map) {
  by_id("summary").textContent = map_summary();
  write_maps();
  dark_scheme.addEventListener("change", write_maps);
}
if (study.growth) {
  by_id("summary").textContent = growth_summary();
  write_growth();
}
if (study.budget) write_budget();
if (study.distributed) write_distributed();
if (study.team) write_team();
if (study.rendezvous) write_rendezvous();
if (study.ways) write_ways();
if (study.directions) write_directions();
write_table();
