// Where we look: (x, y) is the world at the middle of the window, `scale` the pixels for one unit; y goes up in the world.

class Camera {
  constructor(bounds) {
    this.bounds = bounds;
    this.width = this.height = 1;
    this.inset = 0;  // pixels at the left that the panel hides
    this.x = (bounds[0] + bounds[2]) / 2;
    this.y = (bounds[1] + bounds[3]) / 2;
    this.scale = 1;
  }

  get extent() {
    const b = this.bounds;
    return Math.max(b[2] - b[0], b[3] - b[1], Number.MIN_VALUE * 1e10, Math.abs(b[0]) * 1e-12);
  }

  fit() {
    const b = this.bounds, margin = 28, width = Math.max(50, this.width - this.inset - 2 * margin);
    const height = Math.max(50, this.height - 2 * margin);
    const least = this.extent * 1e-6;
    this.scale = Math.min(width / Math.max(b[2] - b[0], least), height / Math.max(b[3] - b[1], least));
    this.x = (b[0] + b[2]) / 2 - this.inset / 2 / this.scale;
    this.y = (b[1] + b[3]) / 2;
    this.fitted = this.scale;
  }

  toX(sx) { return this.x + (sx - this.width / 2) / this.scale; }
  toY(sy) { return this.y - (sy - this.height / 2) / this.scale; }
  screenX(x) { return (x - this.x) * this.scale + this.width / 2; }
  screenY(y) { return (this.y - y) * this.scale + this.height / 2; }

  // Zooms by a factor with the world under the pixel (sx, sy) held still.
  zoom(factor, sx, sy) {
    const wx = this.toX(sx), wy = this.toY(sy), size = Math.min(this.width, this.height);
    // From a tenth of the window for everything, down to where doubles no longer tell neighbouring pixels apart.
    const scale = Math.min(size / (this.extent * 1e-11), Math.max(size / (this.extent * 12), this.scale * factor));
    this.scale = scale;
    this.x = wx - (sx - this.width / 2) / scale;
    this.y = wy + (sy - this.height / 2) / scale;
  }

  pan(dx, dy) {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  // The window in world coordinates, a few pixels larger for the width of lines; `detail`: what is too small to be seen.
  window(pixels = 12) {
    const w = (this.width / 2 + pixels) / this.scale, h = (this.height / 2 + pixels) / this.scale;
    return {left: this.x - w, right: this.x + w, bottom: this.y - h, top: this.y + h, detail: 1 / this.scale};
  }
}
