/**
 * The outline of a shape as corners with a rounding radius: a circle is one corner, a capsule two,
 * a polygon three to eight. One piece of code then draws all of them, exactly at every zoom.
 */

/**
 * @typedef {object} Outline
 * @property {number} body place in `poses`
 * @property {number} corners
 * @property {number} radius m; 0: sharp corners
 * @property {Float64Array} x of the corners, counter-clockwise, in the body's frame
 * @property {Float64Array} y
 * @property {Float64Array} from angle of the outward normal of the edge before a corner
 * @property {Float64Array} to and of the edge after it; from < to
 * @property {boolean} closed a segment without radius encloses nothing
 */

/** @param {import('./view.js').Shapes} shapes @param {number} i @returns {Outline} */
function outlineOf(shapes, i) {
  const first = shapes.first[i];
  const corners = shapes.first[i + 1] - first;
  const outline = {
    body: shapes.body[i],
    corners,
    radius: shapes.radius[i],
    x: new Float64Array(corners),
    y: new Float64Array(corners),
    from: new Float64Array(corners),
    to: new Float64Array(corners),
    closed: corners > 2 || shapes.radius[i] > 0,
  };
  for (let k = 0; k < corners; ++k) {
    outline.x[k] = shapes.vertices[2 * (first + k)];
    outline.y[k] = shapes.vertices[2 * (first + k) + 1];
  }
  const normal = (/** @type {number} */ a, /** @type {number} */ b) =>
    Math.atan2(outline.x[a] - outline.x[b], outline.y[b] - outline.y[a]);
  for (let k = 0; k < corners; ++k) {
    outline.from[k] = normal((k + corners - 1) % corners, k);
    outline.to[k] = normal(k, (k + 1) % corners);
    if (corners === 1) outline.to[k] = outline.from[k] + 2 * Math.PI;
    while (outline.to[k] < outline.from[k]) outline.to[k] += 2 * Math.PI;
  }
  return outline;
}

/** @param {import('./view.js').Shapes} shapes @returns {Outline[]} */
export function outlinesOf(shapes) {
  return Array.from({ length: shapes.count }, (_, i) => outlineOf(shapes, i));
}

/**
 * Adds an outline to the canvas's path, in metres.
 * @param {CanvasRenderingContext2D} canvas
 * @param {Outline} outline
 * @param {Float32Array} poses
 * @param {boolean} round false: too small on the screen for its rounding to be seen
 */
export function trace(canvas, outline, poses, round) {
  const at = 4 * outline.body;
  const px = poses[at];
  const py = poses[at + 1];
  const c = poses[at + 2];
  const s = poses[at + 3];
  const r = outline.radius;
  if (r > 0 && (round || outline.corners === 1)) {
    const turn = Math.atan2(s, c);
    for (let k = 0; k < outline.corners; ++k) {
      const x = px + c * outline.x[k] - s * outline.y[k];
      const y = py + s * outline.x[k] + c * outline.y[k];
      const from = outline.from[k] + turn;
      if (k === 0) canvas.moveTo(x + r * Math.cos(from), y + r * Math.sin(from));
      canvas.arc(x, y, r, from, outline.to[k] + turn);
    }
    canvas.closePath();
    // A line from the middle shows how a disc turns.
    if (outline.corners === 1) {
      canvas.moveTo(px, py);
      canvas.lineTo(
        px + c * (outline.x[0] + r) - s * outline.y[0],
        py + s * (outline.x[0] + r) + c * outline.y[0],
      );
    }
    return;
  }
  for (let k = 0; k < outline.corners; ++k) {
    // Sharp corners stand where the bisector of the two edges, moved out by the radius, meets them.
    const half = (outline.to[k] - outline.from[k]) / 2;
    const out = r > 0 ? r / Math.max(0.35, Math.cos(half)) : 0;
    const middle = outline.from[k] + half;
    const lx = outline.x[k] + out * Math.cos(middle);
    const ly = outline.y[k] + out * Math.sin(middle);
    const x = px + c * lx - s * ly;
    const y = py + s * lx + c * ly;
    if (k === 0) canvas.moveTo(x, y);
    else canvas.lineTo(x, y);
  }
  if (outline.closed) canvas.closePath();
}

/**
 * The part of the world worth looking at: all that can move, and of the rest what is near it.
 * @param {Outline[]} outlines
 * @param {import('./view.js').View} view
 */
export function boundsOf(outlines, view) {
  const isStatic = (/** @type {Outline} */ o) => ((view.flags[o.body] >> 1) & 3) === 0;
  const moving = outlines.filter((o) => !isStatic(o));
  const box = boxOf(moving.length > 0 ? moving : outlines, view.poses);
  if (!box) return { left: -10, right: 10, bottom: -1, top: 10 };
  const reach = 0.35 * Math.max(box.right - box.left, box.top - box.bottom) + 2;
  const near = {
    left: box.left - reach,
    right: box.right + reach,
    bottom: box.bottom - reach,
    top: box.top + reach,
  };
  const fixed = boxOf(outlines.filter(isStatic), view.poses);
  if (!fixed) return box;
  return {
    left: Math.min(box.left, Math.max(fixed.left, near.left)),
    right: Math.max(box.right, Math.min(fixed.right, near.right)),
    bottom: Math.min(box.bottom, Math.max(fixed.bottom, near.bottom)),
    top: Math.max(box.top, Math.min(fixed.top, near.top)),
  };
}

/**
 * One body flung far away must not shrink the rest to a dot: what is farther from the middle 98 %
 * than these are wide is left out.
 * @param {Outline[]} outlines @param {Float32Array} poses
 */
function boxOf(outlines, poses) {
  const xs = [];
  const ys = [];
  for (const o of outlines) {
    const [px, py, c, s] = poses.subarray(4 * o.body, 4 * o.body + 4);
    for (let k = 0; k < o.corners; ++k) {
      const x = px + c * o.x[k] - s * o.y[k];
      const y = py + s * o.x[k] + c * o.y[k];
      if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
      xs.push(x - o.radius, x + o.radius);
      ys.push(y - o.radius, y + o.radius);
    }
  }
  if (xs.length === 0) return null;
  xs.sort((a, b) => a - b);
  ys.sort((a, b) => a - b);
  const last = xs.length - 1;
  const skip = Math.floor(0.01 * xs.length);
  const size = Math.max(xs[last - skip] - xs[skip], ys[last - skip] - ys[skip]);
  return {
    left: Math.max(xs[0], xs[skip] - size),
    right: Math.min(xs[last], xs[last - skip] + size),
    bottom: Math.max(ys[0], ys[skip] - size),
    top: Math.min(ys[last], ys[last - skip] + size),
  };
}
