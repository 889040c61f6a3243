// Data of the study: a table, and the cells of the robustness map.

const study = JSON.parse(document.getElementById("data").textContent);
const cell_key = (sigma, links, paths) => `${sigma}/${links}/${paths}`;
const cells = new Map((study.map ? study.map.cells : []).map(c => [cell_key(c.sigma_angle_deg, c.links, c.false_paths), c]));
