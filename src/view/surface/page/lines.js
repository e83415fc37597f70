// Lines of a width in pixels, as strips of two triangles a segment. (three's own are drawn as instances, which software
// rendering takes ten times as long for.)

import * as THREE from 'three';

const VERTEX = `
  attribute vec3 other;
  attribute float side;
  uniform vec2 window;
  uniform float width;
  #include <clipping_planes_pars_vertex>
  void main() {
    vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
    vec4 mvOther = modelViewMatrix * vec4(other, 1.0);
    // An end behind the eye is moved to the near plane.
    float near = projectionMatrix[3][2] / (projectionMatrix[2][2] - 1.0);
    if (mvPosition.z > -near && mvOther.z < -near)
      mvPosition = mix(mvPosition, mvOther, (mvPosition.z + near) / (mvPosition.z - mvOther.z));
    else if (mvOther.z > -near && mvPosition.z < -near)
      mvOther = mix(mvOther, mvPosition, (mvOther.z + near) / (mvOther.z - mvPosition.z));
    vec4 a = projectionMatrix * mvPosition, b = projectionMatrix * mvOther;
    vec2 along = (b.xy / b.w - a.xy / a.w) * window;
    float length = max(length(along), 1e-6);
    vec2 across = vec2(-along.y, along.x) / length;
    gl_Position = a;
    gl_Position.xy += across * side * width / window * a.w;
    #include <clipping_planes_vertex>
  }`;

const FRAGMENT = `
  uniform vec3 color;
  uniform float opacity;
  #include <clipping_planes_pars_fragment>
  void main() {
    #include <clipping_planes_fragment>
    gl_FragColor = vec4(color, opacity);
  }`;

const windowSize = {
  value: new THREE.Vector2(1, 1)
};

// All lines share the size of the window, in pixels.
export function setWindow(width, height) { windowSize.value.set(width, height); }

// options: opacity, and those of any material.
export function lineMaterial(width, planes, {opacity = 1, ...options} = {}) {
  const material = new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    clipping: true,
    clippingPlanes: planes,
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: -1,
    polygonOffsetUnits: -4,
    transparent: opacity < 1,
    uniforms: {window: windowSize, width: {value: width}, opacity: {value: opacity}, color: {value: new THREE.Color()}},
    ...options,
  });
  material.color = material.uniforms.color.value;
  return material;
}

// points: x, y, z of both ends of each segment in turn.
export function lineGeometry(points) {
  const segments = points.length / 6, geometry = new THREE.BufferGeometry();
  const position = new Float32Array(12 * segments), other = new Float32Array(12 * segments),
        side = new Int8Array(4 * segments);
  const index = new (4 * segments > 65535 ? Uint32Array : Uint16Array)(6 * segments);
  for (let s = 0; s < segments; ++s) {
    for (let corner = 0; corner < 4; ++corner) {
      const end = corner >> 1, v = 4 * s + corner;
      for (let i = 0; i < 3; ++i) {
        position[3 * v + i] = points[6 * s + 3 * end + i];
        other[3 * v + i] = points[6 * s + 3 * (1 - end) + i];
      }
      // Seen from its own end, left is right at the other one.
      side[v] = (corner & 1) === end ? 1 : -1;
    }
    index.set([0, 1, 2, 2, 1, 3].map(k => 4 * s + k), 6 * s);
  }
  geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
  geometry.setAttribute('other', new THREE.BufferAttribute(other, 3));
  geometry.setAttribute('side', new THREE.BufferAttribute(side, 1));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  return geometry;
}

// Lines whose points change: replace(points).
export class Lines extends THREE.Mesh {
  constructor(material, order) {
    super(new THREE.BufferGeometry(), material);
    this.frustumCulled = false;
    this.renderOrder = order;
    this.visible = false;
  }
  replace(points) {
    this.geometry.dispose();
    this.visible = points.length > 0;
    if (this.visible) this.geometry = lineGeometry(points);
  }
}
