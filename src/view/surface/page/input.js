// Mouse, fingers and keys.

import * as THREE from 'three';

const CLICK = 5;  // pixels that a hand may shake
const TURN = Math.PI / 24;

export class Input {
  // actions: rollTo(px, py), roll(dx, dy) in tenths of the radius, hold(), release(), fit(), top(), and `keys`: what else keys do.
  constructor(canvas, scene, actions) {
    Object.assign(this, {canvas, scene, actions});
    canvas.addEventListener('pointerdown', event => {
      this.down = [event.clientX, event.clientY];
      canvas.classList.add('moving');
    });
    canvas.addEventListener('pointermove', event => {
      // A mouse rolls the ball while no button is pressed; a finger or pen puts it down.
      if (event.pointerType === 'mouse' && event.buttons === 0) this.follow(event.clientX, event.clientY);
    });
    window.addEventListener('pointerup', event => {
      canvas.classList.remove('moving');
      if (!this.down) return;
      const moved = Math.hypot(event.clientX - this.down[0], event.clientY - this.down[1]);
      this.down = null;
      if (event.target !== canvas || moved > CLICK) return;
      if (event.pointerType === 'mouse' && event.button === 0) this.actions.hold();
      this.follow(event.clientX, event.clientY, true);
    });
    canvas.addEventListener('keydown', event => this.key(event));
  }

  // At most once a picture.
  follow(x, y, now = false) {
    this.at = [x, y];
    if (now) {
      this.actions.rollTo(x, y, true);
      return;
    }
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.actions.rollTo(...this.at, false);
    });
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const {actions} = this, step = event.shiftKey ? 10 : 1;
    const keys = {
      ArrowLeft: () => event.shiftKey ? this.turn(TURN, 0) : this.move(-1, 0),
      ArrowRight: () => event.shiftKey ? this.turn(-TURN, 0) : this.move(1, 0),
      ArrowUp: () => event.shiftKey ? this.turn(0, -TURN) : this.move(0, 1),
      ArrowDown: () => event.shiftKey ? this.turn(0, TURN) : this.move(0, -1),
      '+': () => this.zoom(1 / 1.4),
      '=': () => this.zoom(1 / 1.4),
      '-': () => this.zoom(1.4),
      '0': actions.fit,
      t: actions.top,
      a: () => this.roll(-step, 0),
      d: () => this.roll(step, 0),
      w: () => this.roll(0, step),
      s: () => this.roll(0, -step),
      Escape: actions.release,
      ...actions.keys,
    };
    const act = keys[event.key] ?? keys[event.key.toLowerCase()];
    if (!act) return;
    event.preventDefault();
    act();
  }

  // To the right and away, as the eye sees it.
  axes() {
    const away = this.scene.camera.getWorldDirection(new THREE.Vector3()).setZ(0);
    if (away.length() < 1e-6) away.set(0, 1, 0).applyQuaternion(this.scene.camera.quaternion).setZ(0);
    away.normalize();
    return {away, right: new THREE.Vector3(away.y, -away.x, 0)};
  }

  move(x, y) {
    const {scene} = this, {away, right} = this.axes();
    const length = 0.12 * scene.camera.position.distanceTo(scene.controls.target);
    const step = right.multiplyScalar(x * length).add(away.multiplyScalar(y * length));
    scene.look(scene.controls.target.clone().add(step), scene.camera.position.clone().add(step));
    scene.request(true);
  }

  turn(about, up) {
    const {scene} = this, {target} = scene.controls, offset = scene.camera.position.clone().sub(target);
    const polar = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    polar.theta += about;
    polar.phi = Math.min(scene.controls.maxPolarAngle, Math.max(1e-3, polar.phi + up));
    const turned = new THREE.Vector3().setFromSpherical(polar);
    scene.look(target.clone(), target.clone().add(new THREE.Vector3(turned.x, -turned.z, turned.y)));
    scene.request(true);
  }

  zoom(factor) {
    const {scene} = this, {target} = scene.controls;
    scene.look(target.clone(), target.clone().add(scene.camera.position.clone().sub(target).multiplyScalar(factor)));
    scene.request(true);
  }

  roll(x, y) {
    const {away, right} = this.axes(), step = right.multiplyScalar(x).add(away.multiplyScalar(y));
    this.actions.roll(step.x, step.y);
  }
}
