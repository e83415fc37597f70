// The ball against one feature of the terrain, in closed form: what krepl's patches are.

// Contacts beyond a feature's end by so much of its size count: there the
// neighbour's patch has the same height and slope.
const SLACK = 1e-12;

// A feature with what does not depend on the place: points is an array of 1, 2 or 3 points [x, y, z].
export function makePatch(points, radius) {
  const [a, b, c] = points, patch = {points, radius, a};
  if (points.length === 2) {
    const d = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    patch.length = Math.hypot(...d);
    patch.direction = d.map(v => v / patch.length);
    patch.flat = Math.hypot(patch.direction[0], patch.direction[1]);
  } else if (points.length === 3) {
    const u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]], v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.sign(n[2]) * Math.hypot(...n);
    patch.normal = n.map(x => x / length);
    patch.u = u;
    patch.v = v;
    patch.area = n[2];
  }
  return patch;
}

// Height of the ball's centre while it touches the feature and stands over (x, y),
// and where it touches; null if it cannot.
export function touch(patch, x, y) {
  if (patch.points.length === 1) return touchVertex(patch, x, y);
  return patch.points.length === 2 ? touchEdge(patch, x, y) : touchFace(patch, x, y);
}

function touchVertex({a, radius}, x, y) {
  const dx = x - a[0], dy = y - a[1], square = radius * radius - dx * dx - dy * dy;
  if (square < -SLACK * radius * radius) return null;
  return {height: a[2] + Math.sqrt(Math.max(0, square)), at: a};
}

function touchEdge({a, radius, direction: d, flat, length}, x, y) {
  if (flat === 0) return null;
  const dx = x - a[0], dy = y - a[1];
  const aside = (d[0] * dy - d[1] * dx) / flat, square = radius * radius - aside * aside;
  if (square < -SLACK * radius * radius) return null;
  const height = ((d[0] * dx + d[1] * dy) / flat * d[2] + Math.sqrt(Math.max(0, square))) / flat;
  const along = dx * d[0] + dy * d[1] + height * d[2];
  if (along < -SLACK * length || along > (1 + SLACK) * length) return null;
  return {height: a[2] + height, at: [a[0] + along * d[0], a[1] + along * d[1], a[2] + along * d[2]]};
}

function touchFace({a, radius, normal: n, u, v, area}, x, y) {
  const px = x - a[0] - radius * n[0], py = y - a[1] - radius * n[1];
  // Share of u and v in the point that is touched.
  const s = (px * v[1] - py * v[0]) / area, t = (u[0] * py - u[1] * px) / area;
  if (s < -SLACK || t < -SLACK || s + t > 1 + SLACK) return null;
  const height = a[2] + s * u[2] + t * v[2] + radius * n[2];
  return {height, at: [a[0] + px, a[1] + py, a[2] + s * u[2] + t * v[2]]};
}

// Unit normal, upwards, at a place of the patch.
export function normalAt(patch, x, y, z, out) {
  if (patch.normal) {
    [out[0], out[1], out[2]] = patch.normal;
    return out;
  }
  let nx = x - patch.a[0], ny = y - patch.a[1], nz = z - patch.a[2];
  if (patch.direction) {
    const d = patch.direction, along = nx * d[0] + ny * d[1] + nz * d[2];
    nx -= along * d[0];
    ny -= along * d[1];
    nz -= along * d[2];
  }
  const length = Math.hypot(nx, ny, nz) || 1;
  out[0] = nx / length;
  out[1] = ny / length;
  out[2] = nz / length;
  return out;
}
