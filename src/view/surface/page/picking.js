// Where a ray from the eye meets what is drawn, and then the exact surface.

// Entry of a ray into a box, or Infinity.
export function entryOf(tile, origin, direction) {
  let enter = 0, leave = Infinity;
  for (let i = 0; i < 3; ++i) {
    const a = (tile.low[i] - origin[i]) / direction[i], b = (tile.high[i] - origin[i]) / direction[i];
    if (Number.isNaN(a) || Number.isNaN(b)) continue;  // along the plane of a side
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave ? enter : Infinity;
}

// Nearest hit of a ray with triangles; allowed(t) may refuse one.
export function hitTriangles({position, index}, origin, d, allowed, nearest = Infinity) {
  for (let k = 0; k < index.length; k += 3) {
    const a = 3 * index[k], b = 3 * index[k + 1], c = 3 * index[k + 2];
    const ux = position[b] - position[a], uy = position[b + 1] - position[a + 1],
          uz = position[b + 2] - position[a + 2];
    const vx = position[c] - position[a], vy = position[c + 1] - position[a + 1],
          vz = position[c + 2] - position[a + 2];
    const px = d[1] * vz - d[2] * vy, py = d[2] * vx - d[0] * vz, pz = d[0] * vy - d[1] * vx;
    const volume = ux * px + uy * py + uz * pz;
    if (volume === 0) continue;
    const wx = origin[0] - position[a], wy = origin[1] - position[a + 1], wz = origin[2] - position[a + 2];
    const s = (wx * px + wy * py + wz * pz) / volume;
    if (s < 0 || s > 1) continue;
    const qx = wy * uz - wz * uy, qy = wz * ux - wx * uz, qz = wx * uy - wy * ux;
    const r = (d[0] * qx + d[1] * qy + d[2] * qz) / volume;
    if (r < 0 || s + r > 1) continue;
    const t = (vx * qx + vy * qy + vz * qz) / volume;
    if (t > 0 && t < nearest && allowed(t)) nearest = t;
  }
  return nearest;
}

const WIDENINGS = 12, STEPS = 60;

// The place near origin + t * direction at which the ray meets the exact surface; null if it does not come through
// there. step: about how far off the drawn triangles may be.
export function refine(envelope, origin, direction, t, step) {
  const at = s => [0, 1, 2].map(i => origin[i] + s * direction[i]);
  const above = s => {
    const [x, y, z] = at(s), contact = envelope.contact(x, y);
    return contact ? z - contact.height : NaN;
  };
  for (let k = 0, width = step; k < WIDENINGS; ++k, width *= 2) {
    let high = t - width, low = t + width;
    if (!(above(high) >= 0 && above(low) < 0)) continue;
    for (let i = 0; i < STEPS; ++i) {
      const middle = (high + low) / 2;
      if (above(middle) >= 0)
        high = middle;
      else
        low = middle;
    }
    return at(high);
  }
  return null;
}
