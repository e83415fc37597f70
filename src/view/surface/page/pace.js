// How many triangles a moving picture may have: as many as keep up with the hand on this
// machine, be it without graphics hardware.

const QUICK = 22, SLOW = 45;          // milliseconds between two pictures
const MOST = 1500000, LEAST = 40000;  // triangles
const SMALLEST = 0.5;                 // of the pixels a side

export class Pace {
  constructor() {
    this.budget = 160000;
    this.scale = 1;
  }

  // After a moving picture that came so long after the one before.
  took(milliseconds) {
    if (milliseconds > SLOW) {
      // By as much as it was too slow, but not at once: the first picture after a rest tells little.
      if (this.budget === LEAST) this.scale = Math.max(SMALLEST, this.scale * 0.8);
      this.budget = Math.max(LEAST, this.budget * Math.max(0.6, SLOW / milliseconds));
    } else if (milliseconds < QUICK) {
      if (this.scale < 1)
        this.scale = Math.min(1, this.scale * 1.25);
      else
        this.budget = Math.min(MOST, this.budget * 1.15);
    }
  }

  get moving() { return {detail: 2.4, budget: this.budget, lineBudget: this.budget / 8, milliseconds: 8}; }
  // Nobody waits for the next picture.
  get resting() {
    return {
      detail: 1.8,
      budget: Math.min(MOST, Math.max(400000, 6 * this.budget)),
      lineBudget: Math.max(60000, this.budget),
      milliseconds: 150
    };
  }
}
