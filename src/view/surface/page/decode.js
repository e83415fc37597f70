// Tiles as src/view/surface/tile_encoding.cpp writes them.

import {unzlibSync} from 'fflate';

export function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// Arrays stand byte by byte of equal weight.
export class PlaneReader {
  constructor(packed) {
    this.raw = unzlibSync(packed);
    this.at = 0;
  }
  bytes(count) { return this.raw.slice(this.at, this.at += count); }
  words(count) { return new Uint32Array(this.planes(count, 4)); }
  doubles(count) { return new Float64Array(this.planes(count, 8)); }
  planes(count, size) {
    const together = new Uint8Array(count * size);
    for (let plane = 0; plane < size; ++plane)
      for (let i = 0, to = plane; i < count; ++i, to += size) together[to] = this.raw[this.at++];
    return together.buffer;
  }
}

// In place: each number is the difference from the one before, its sign in the lowest bit.
export function undoDifferences(words) {
  for (let i = 0, value = 0; i < words.length; ++i) {
    const coded = words[i];
    value += coded & 1 ? -(coded + 1) / 2 : coded / 2;
    words[i] = value;
  }
  return words;
}

// In place: 0 is the next number that was not there before, n the one n before that.
export function undoBelowHighest(words) {
  for (let i = 0, next = 0; i < words.length; ++i) {
    const value = next - words[i];
    if (words[i] === 0) ++next;
    words[i] = value;
  }
  return words;
}

function starts(counts) {
  const first = new Uint32Array(counts.length + 1);
  for (let i = 0; i < counts.length; ++i) first[i + 1] = first[i] + counts[i];
  return first;
}

function quantised(reader, count, low, high) {
  const values = new Float64Array(count), whole = undoDifferences(reader.words(count));
  for (let i = 0; i < count; ++i) values[i] = low + (high - low) * (whole[i] / 65535);
  return values;
}

// box: low and high corner of the tile; exact: vertices are doubles (terrains).
export function decodeLeaf(packed, box, exact) {
  const reader = new PlaneReader(packed);
  const [vertices, faces, corners, features, featurePoints, points, lines, lineVertices] = reader.words(8);
  const axis = i => exact ? reader.doubles(vertices) : quantised(reader, vertices, box.low[i], box.high[i]);
  const leaf = {x: axis(0), y: axis(1), z: axis(2)};
  leaf.faceKind = reader.bytes(faces);
  leaf.faceFirst = starts(reader.words(faces));
  leaf.corner = undoBelowHighest(reader.words(corners));
  leaf.feature = undoDifferences(reader.words(features));
  leaf.featurePoint = undoBelowHighest(reader.words(featurePoints));
  leaf.point = {x: reader.doubles(points), y: reader.doubles(points), z: reader.doubles(points)};
  leaf.lineKind = reader.bytes(lines);
  leaf.lineFirst = starts(reader.words(lines));
  leaf.lineVertex = undoDifferences(reader.words(lineVertices));
  // Walls and ground have no feature; the others have one each, of one point more than the number of their kind.
  leaf.featureOf = new Int32Array(faces).fill(-1);
  leaf.pointFirst = new Uint32Array(features);
  for (let f = 0, k = 0, at = 0; f < faces; ++f) {
    if (leaf.faceKind[f] > 2) continue;
    leaf.featureOf[f] = k;
    leaf.pointFirst[k++] = at;
    at += leaf.faceKind[f] + 1;
  }
  return leaf;
}

export const CELLS = 32;       // of a tile of samples, a side
export const ROW = CELLS + 3;  // samples a side: one cell more all around

export function decodeSamples(packed) {
  const reader = new PlaneReader(packed), count = ROW * ROW;
  const [low, high] = reader.doubles(2);
  const whole = undoDifferences(reader.words(count)), z = new Float64Array(count);
  for (let i = 0; i < count; ++i) z[i] = whole[i] === 0 ? NaN : low + (high - low) * ((whole[i] - 1) / 65534);
  return {z, cylinder: reader.bytes(count), sphere: reader.bytes(count)};
}
