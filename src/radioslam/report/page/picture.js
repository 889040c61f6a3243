// Occupancy image of the robots' scans: cells under the trajectories, darker if hit more often.

const picture_levels = 9;
const moving_cells = 15000;  // drawn while the view moves

/// Cell corners in the page's metres, by number of hits.
function unpack_picture(picture) {
  if (!picture) return null;
  const { cell_m, x, y, yaw } = picture, c = Math.cos(yaw), s = Math.sin(yaw);
  const xs = new Float64Array(picture.cells), ys = new Float64Array(picture.cells), hits = new Uint8Array(picture.cells);
  let n = 0;
  picture.rows.forEach(([j, ...columns_of], row) => {
    let i = 0;
    columns_of.forEach((step, k) => {
      i += step;
      const u = (i + 0.5) * cell_m, v = (j + 0.5) * cell_m;
      xs[n] = x + c * u - s * v;
      ys[n] = y + s * u + c * v;
      hits[n++] = Number(picture.hits[row][k]);
    });
  });
  return { cell_m, xs, ys, hits };
}

const pictures = robots.map(robot => unpack_picture(robot.picture));
const picture_cells = total(pictures, picture => (picture ? picture.xs.length : 0));
const picture_scans = total(robots, robot => (robot.picture ? robot.picture.scans : 0));

/// 1 % and 99 % quantiles of the cells, so that a few distant ones do not shrink the map.
const picture_spans = pictures.map(picture => {
  const span = values => (values.length ? [0.01, 0.99].map(q => d3.quantile(Array.from(values).sort(d3.ascending), q)) : []);
  return { x: span(picture ? picture.xs : []), y: span(picture ? picture.ys : []) };
});

/// Only in the view from above.
function draw_pictures(context, view) {
  if (state.axes[0] !== "x" || state.axes[1] !== "y") return;
  const stride = view.moving ? Math.ceil(picture_cells / moving_cells) : 1;
  context.fillStyle = css("walls");
  for (const robot of shown()) {
    const picture = pictures[robot.index];
    if (!picture) continue;
    const size = Math.max(1.2, view.k * picture.cell_m * Math.sqrt(stride));
    for (let level = 1; level <= picture_levels; ++level) {
      context.globalAlpha = (fades(robot.index) ? 0.3 : 1) * Math.min(1, 0.25 + 0.2 * level);
      for (let n = 0; n < picture.xs.length; n += stride) {
        if (picture.hits[n] !== level) continue;
        const px = view.ox + view.k * picture.xs[n], py = view.oy - view.k * picture.ys[n];
        if (px > -size && py > -size && px < view.width + size && py < view.height + size)
          context.fillRect(px - size / 2, py - size / 2, size, size);
      }
    }
  }
  context.globalAlpha = 1;
}
