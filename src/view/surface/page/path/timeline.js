// The tool's way as straight pieces in time, as src/view/path/path_page.cpp writes it.

import {bytesOf, PlaneReader} from '../decode.js';

export const RAPID = 0, LINE = 1, CLOCKWISE = 2, COUNTER_CLOCKWISE = 3;

export class Timeline {
  // text(id): the base64 text of an array of the page. Piece p runs from point p to point p + 1.
  constructor(description, text) {
    this.pieces = description.pieces;
    this.minutes = description.minutes;
    const track = new PlaneReader(bytesOf(text(description.track))), points = this.pieces + 1;
    this.x = track.doubles(points);
    this.y = track.doubles(points);
    this.z = track.doubles(points);
    this.time = track.doubles(points);
    this.move = track.words(this.pieces);
    const moves = new PlaneReader(bytesOf(text(description.moveTable)));
    this.kind = moves.bytes(description.moves);
    this.feed = moves.doubles(description.moves);
    this.line = moves.raw.length - moves.at >= 4 * description.moves ? moves.words(description.moves) : null;
  }

  kindOf(piece) { return this.kind[this.move[piece]]; }

  // The last piece that has begun at a time, by bisection.
  pieceAt(time) {
    let low = 0, high = this.pieces - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time[middle] <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  // Where the tool's tip is, and in which piece.
  at(time) {
    const piece = this.pieceAt(time), begin = this.time[piece], span = this.time[piece + 1] - begin;
    const t = span > 0 ? Math.min(1, Math.max(0, (time - begin) / span)) : 1;
    const along = values => values[piece] + t * (values[piece + 1] - values[piece]);
    return {piece, t, x: along(this.x), y: along(this.y), z: along(this.z)};
  }

  // When the next move begins, or the one before: for steps of a hand.
  step(time, direction) {
    const {piece, t} = this.at(time), now = this.move[piece];
    if (direction > 0) {
      for (let p = piece; p < this.pieces; ++p)
        if (this.move[p] !== now) return this.time[p];
      return this.minutes;
    }
    let p = piece;
    while (p > 0 && this.move[p - 1] === now) --p;
    if (this.time[p] < time || p === 0) return this.time[p];
    for (--p; p > 0 && this.move[p - 1] === this.move[p];) --p;
    return this.time[p];
  }

  get low() { return [this.x, this.y, this.z].map(values => values.reduce((a, b) => Math.min(a, b))); }
  get high() { return [this.x, this.y, this.z].map(values => values.reduce((a, b) => Math.max(a, b))); }
}
