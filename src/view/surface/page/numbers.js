// Numbers for people.

// 1, 2 or 5 times a power of ten, at least `least`.
export function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map(f => f * power).find(step => step >= least * (1 - 1e-12));
}

// With as many digits as a step of a scale needs.
export function text(value, step) {
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return (Math.abs(value) < step / 2 ? 0 : value).toFixed(Math.min(12, digits)).replace('-', '\u2212');
}

// Thousands apart by thin spaces.
export function grouped(value) { return String(value).replace(/\B(?=(\d{3})+$)/g, '\u2009'); }

// A coordinate to a part of `unit` in a million, without trailing zeros.
export function rounded(value, unit) {
  const digits = Math.min(12, Math.max(0, 6 - Math.floor(Math.log10(unit))));
  return String(Number(value.toFixed(digits))).replace('-', '\u2212');
}

// With twelve digits, which is what the surface is good for.
export function exact(value) { return String(Number(value.toPrecision(12))).replace('-', '\u2212'); }
