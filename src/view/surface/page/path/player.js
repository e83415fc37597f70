// Time: play and pause, the slider, the speed, and what is said of the moment.

const byId = id => document.getElementById(id);
const STEPS = 100000;      // of the slider
const WHOLE_IN = 30;       // seconds, at the speed that a page begins with

// Minutes as h:mm:ss or m:ss.s.
export function clock(minutes) {
  const seconds = Math.max(0, minutes * 60), whole = Math.floor(seconds);
  const two = n => String(n).padStart(2, '0');
  if (whole >= 3600) return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
  return `${Math.floor(whole / 60)}:${(seconds % 60).toFixed(1).padStart(4, '0')}`;
}

export class Player {
  // changed(time): minutes
  constructor(timeline, changed) {
    Object.assign(this, {timeline, changed, time: 0, playing: false});
    this.slider = byId('clock');
    this.slider.max = STEPS;
    this.speeds = byId('speed');
    this.slider.addEventListener('input', () => this.set(this.slider.value / STEPS * timeline.minutes));
    byId('play').addEventListener('click', () => this.play(!this.playing));
  }

  // Minutes that pass in one of ours.
  get speed() {
    return this.speeds.value === 'fit' ? Math.max(this.timeline.minutes, 1e-9) * 60 / WHOLE_IN : Number(this.speeds.value);
  }

  set(time) {
    this.time = Math.min(this.timeline.minutes, Math.max(0, time));
    this.slider.value = this.timeline.minutes > 0 ? this.time / this.timeline.minutes * STEPS : 0;
    this.slider.setAttribute('aria-valuetext', `${clock(this.time)} of ${clock(this.timeline.minutes)}`);
    this.changed(this.time);
  }

  step(direction) {
    this.play(false);
    this.set(this.timeline.step(this.time, direction));
  }

  play(on) {
    if (on && this.time >= this.timeline.minutes) this.set(0);
    if (on === this.playing) return;
    this.playing = on;
    document.documentElement.classList.toggle('playing', on);
    byId('play').setAttribute('aria-label', on ? 'Pause' : 'Play');
    byId('play').title = (on ? 'Pause' : 'Play') + ' (space)';
    if (!on) return;
    let last = null;
    const tick = now => {
      if (!this.playing) return;
      if (last !== null) this.set(this.time + (now - last) / 60000 * this.speed);
      last = now;
      if (this.time >= this.timeline.minutes) this.play(false);
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
}
