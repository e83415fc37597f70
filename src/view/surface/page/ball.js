// The ball where it rests, what it touches, and the patch its centre is on.

import * as THREE from 'three';

import {middleOf} from './geometry.js';
import {lineMaterial, Lines} from './lines.js';
import {glassMaterial} from './materials.js';
import {entryOf, hitTriangles, refine} from './picking.js';

const always = {
  depthTest: false,
  depthWrite: false,
  transparent: true
};

export class Ball {
  constructor(scene, envelope, radius) {
    Object.assign(this, {scene, envelope, radius});
    this.rest = null;  // { x, y, height, touches }
    this.group = new THREE.Group();
    this.group.visible = false;
    this.body = new THREE.Mesh(new THREE.SphereGeometry(radius, 64, 40), glassMaterial());
    this.body.renderOrder = 10;
    this.inner = new THREE.Group();  // relative to the centre
    this.inner.add(this.body);
    this.spokes = this.lines(1.6, 12);
    this.outline = this.lines(2.6, 11);
    this.dots = this.points(11, 13);
    this.patch = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({
      transparent: true,
      opacity: 0.5,
      side: THREE.DoubleSide,
      depthWrite: false,
      polygonOffset: true,
      polygonOffsetFactor: 0,
      polygonOffsetUnits: -2
    }));
    this.patch.renderOrder = 2;
    this.patch.frustumCulled = false;
    this.group.add(this.inner, this.patch);
    scene.scene.add(this.group);
  }

  lines(width, order) {
    const lines = new Lines(lineMaterial(width, [], always), order);
    this.inner.add(lines);
    return lines;
  }

  points(size, order) {
    const shader = new THREE.PointsMaterial({size, sizeAttenuation: false, ...always});
    // Round, with a pale border.
    shader.onBeforeCompile = program => {
      program.fragmentShader = program.fragmentShader.replace('#include <color_fragment>', `
        float off = length(gl_PointCoord - 0.5) * 2.0;
        if (off > 1.0) discard;
        diffuseColor.rgb = off > 0.68 ? vec3(1.0) : diffuseColor.rgb;`);
    };
    const points = new THREE.Points(new THREE.BufferGeometry(), shader);
    points.frustumCulled = false;
    points.renderOrder = order;
    this.inner.add(points);
    return points;
  }

  setTheme(colors) {
    this.body.material.uniforms.color.value.set(colors.ball);
    this.body.material.uniforms.rim.value.set(colors.cut);
    for (const part of [this.spokes, this.outline, this.dots, this.patch]) part.material.color.set(colors.contact);
  }

  // Lets the ball down over (x, y). Returns where it rests, or null: then it stays where it was.
  place(x, y) {
    const contact = this.envelope.contact(x, y);
    if (!contact) return null;
    this.rest = {x, y, ...contact};
    const center = [x, y, contact.height], relative = p => p.map((v, i) => v - center[i]);
    this.group.visible = true;
    this.inner.position.set(...center);
    const at = contact.touches.map(t => relative(t.at));
    this.spokes.replace(at.flatMap(p => [0, 0, 0, ...p]));
    this.dots.geometry.dispose();
    this.dots.geometry =
        new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), ...at.map(p => new THREE.Vector3(...p))]);
    this.outline.replace(contact.touches.flatMap(t => outlineOf(t.points).map(relative)).flat());
    this.showPatch(contact.touches[0]);
    this.scene.request(true);
    return this.rest;
  }

  // The face of the subdivision that the centre is on.
  showPatch({leaf, face, tile}) {
    const middle = middleOf(tile), first = 3 * leaf.faceFirst[face], last = 3 * leaf.faceFirst[face + 1];
    const position = new Float32Array(3 * (last - first));
    for (let c = first, k = 0; c < last; ++c) {
      const v = leaf.corner[c];
      position[k++] = leaf.x[v] - middle[0];
      position[k++] = leaf.y[v] - middle[1];
      position[k++] = leaf.z[v] - middle[2];
    }
    this.patch.geometry.dispose();
    this.patch.geometry = new THREE.BufferGeometry().setAttribute('position', new THREE.BufferAttribute(position, 3));
    this.patch.position.set(...middle);
  }

  remove() {
    this.rest = null;
    this.group.visible = false;
    this.scene.request();
  }

  // The place of the exact surface under a pixel; null if there is none.
  placeUnder(px, py) {
    const {origin, direction} = this.scene.ray(px, py), set = this.scene.surface;
    const plane = this.scene.cutting ? this.scene.cutPlane : null;
    const allowed = t => !plane ||
        [0, 1, 2].reduce(
            (sum, i) => sum + plane.normal.getComponent(i) * (origin[i] + t * direction[i]), plane.constant) >= 0;
    let nearest = Infinity, cell = 0;
    const entered = set.chosen.map(tile => ({tile, t: entryOf(tile, origin, direction)})).filter(({t}) => t < Infinity);
    for (const {tile, t} of entered.sort((a, b) => a.t - b.t)) {
      if (t > nearest) break;
      const middle = middleOf(tile);
      const hit = hitTriangles(
          set.meshes.get(tile.index).arrays, origin.map((v, i) => v - middle[i]), direction, allowed, nearest);
      if (hit < nearest) [nearest, cell] = [hit, tile.leaf ? this.radius / 100 : tile.cell];
    }
    if (nearest === Infinity) return null;
    return refine(this.envelope, origin, direction, nearest, cell) ?? origin.map((v, i) => v + nearest * direction[i]);
  }
}

// Sides of a triangle, an edge; nothing of a vertex.
function outlineOf(points) {
  if (points.length === 2) return [points[0], points[1]];
  return points.length === 3 ? [0, 1, 1, 2, 2, 0].map(i => points[i]) : [];
}
