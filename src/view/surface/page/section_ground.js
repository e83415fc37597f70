// A vertical section of triangles.

const CLOSE = 1e-12;

// Segments [s, z, s, z] in which a vertical plane along the line meets the terrain's triangles, between from and to.
export function groundSection(layer, line, from, to) {
  const {at, along, normal} = line, segments = [];
  const off = (x, y) => (x - at[0]) * normal[0] + (y - at[1]) * normal[1];
  const meets = tile => {
    let low = Infinity, high = -Infinity, least = Infinity, most = -Infinity;
    for (const x of [tile.low[0], tile.high[0]]) {
      for (const y of [tile.low[1], tile.high[1]]) {
        const d = off(x, y), s = (x - at[0]) * along[0] + (y - at[1]) * along[1];
        low = Math.min(low, d);
        high = Math.max(high, d);
        least = Math.min(least, s);
        most = Math.max(most, s);
      }
    }
    const slack = CLOSE * (Math.abs(low) + Math.abs(high));
    return low <= slack && high >= -slack && least <= to && most >= from;
  };
  for (const tile of layer.leaves(meets)) {
    const leaf = layer.decoded(tile), count = leaf.x.length;
    const d = new Float64Array(count), s = new Float64Array(count);
    for (let v = 0; v < count; ++v) {
      d[v] = off(leaf.x[v], leaf.y[v]);
      s[v] = (leaf.x[v] - at[0]) * along[0] + (leaf.y[v] - at[1]) * along[1];
    }
    for (let k = 0; k < leaf.corner.length; k += 3) {
      const points = [];
      for (let i = 0; i < 3; ++i) {
        const a = leaf.corner[k + i], b = leaf.corner[k + (i + 1) % 3];
        // A vertex in the plane counts for its left side, so that each side is crossed once or not at all.
        if ((d[a] < 0) === (d[b] < 0)) continue;
        const t = d[a] / (d[a] - d[b]);
        points.push(s[a] + t * (s[b] - s[a]), leaf.z[a] + t * (leaf.z[b] - leaf.z[a]));
      }
      if (points.length !== 4 || Math.max(points[0], points[2]) < from || Math.min(points[0], points[2]) > to) continue;
      segments.push(points[0] <= points[2] ? points : [points[2], points[3], points[0], points[1]]);
    }
  }
  segments.sort((a, b) => a[0] - b[0]);
  return segments;
}
