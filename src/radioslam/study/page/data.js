// The study's data: a table, and for the robustness map the cells behind it.

const study = JSON.parse(document.getElementById("data").textContent);
const cell_key = (sigma, links, paths) => `${sigma}/${links}/${paths}`;
const cells = new Map((study.map ? study.map.cells : []).map(c => [cell_key(c.sigma_angle_deg, c.links, c.false_paths), c]));
