// Vertical sections of the exact surface.

// A line in the plane: through `at`, in the direction of `angle` (radians, from x to y).
export function lineOf(at, angle) {
  const along = [Math.cos(angle), Math.sin(angle)];
  return {at, along, normal: [-along[1], along[0]], place: s => [at[0] + s * along[0], at[1] + s * along[1]]};
}

// The range of s in which a line runs over a box; null if it does not.
export function rangeOver(line, low, high) {
  let from = -Infinity, to = Infinity;
  for (const i of [0, 1]) {
    const a = (low[i] - line.at[i]) / line.along[i], b = (high[i] - line.at[i]) / line.along[i];
    if (Number.isNaN(a) || Number.isNaN(b) || !Number.isFinite(a) || !Number.isFinite(b)) {
      if (line.at[i] < low[i] || line.at[i] > high[i]) return null;
      continue;
    }
    from = Math.max(from, Math.min(a, b));
    to = Math.min(to, Math.max(a, b));
  }
  return from < to ? [from, to] : null;
}

const label = contact => contact ? contact.touches[0].feature : -1;

// Pieces of the surface's section between from and to, in order: { feature, kind, points: [s, z, s, z, ...] }; each has
// one patch, all its points lie on that patch's true curve, and its ends are where the patch ends to within
// `tolerance`. Where patches follow each other more closely than (to - from) / count, some may be missed.
export function surfaceSection(envelope, line, from, to, count, tolerance) {
  const sample = s => {
    const contact = envelope.contact(...line.place(s));
    return {s, z: contact ? contact.height : NaN, label: label(contact), kind: contact ? contact.touches[0].kind : -1};
  };
  const pieces = [];
  const add = p => {
    if (p.label < 0) return;
    const last = pieces[pieces.length - 1];
    if (last && last.feature === p.label && !last.ended)
      last.points.push(p.s, p.z);
    else
      pieces.push({feature: p.label, kind: p.kind, points: [p.s, p.z], ended: false});
  };
  const end = () => {
    if (pieces.length > 0) pieces[pieces.length - 1].ended = true;
  };
  // Everything between two samples that are told apart; the first one is there already.
  const between = (a, b) => {
    if (a.label === b.label) return;
    if (b.s - a.s <= tolerance) {
      end();
      return;
    }
    const middle = sample((a.s + b.s) / 2);
    if (middle.s <= a.s || middle.s >= b.s) {
      end();
      return;
    }
    between(a, middle);
    add(middle);
    between(middle, b);
  };
  let before = sample(from);
  add(before);
  for (let i = 1; i <= count; ++i) {
    const next = sample(from + (to - from) * i / count);
    between(before, next);
    add(next);
    before = next;
  }
  return pieces.map(({feature, kind, points}) => ({feature, kind, points: Float64Array.from(points)}));
}
