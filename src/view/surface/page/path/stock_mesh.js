// The material as a mesh over its dexels: heights are a texture, so that a cut costs no new triangles.

import * as THREE from 'three';

import {PATH_COLORS} from './colors.js';

const VERTEX = `
  uniform highp sampler2D heights, parts, starts, gouges;
  uniform vec2 first;
  uniform float cell, bottom;
  varying vec3 vView;
  varying float vRest, vCut, vGouge;
  void main() {
    // A ring of dexels beside the block hangs down to its bottom.
    ivec2 size = textureSize(heights, 0);
    ivec2 at = ivec2(position.xy), dexel = clamp(at, ivec2(0), size - 1);
    float height = texelFetch(heights, dexel, 0).r, part = texelFetch(parts, dexel, 0).r;
    vRest = part < -1e29 ? 0.0 : max(height - part, 0.0);
    vCut = height < texelFetch(starts, dexel, 0).r ? 1.0 : 0.0;
    vGouge = height < part ? texelFetch(gouges, dexel, 0).r : 0.0;
    vec4 view = modelViewMatrix * vec4(first + cell * vec2(dexel), at == dexel ? height : bottom, 1.0);
    vView = view.xyz;
    gl_Position = projectionMatrix * view;
  }`;

const FRAGMENT = `
  uniform vec3 stockPaint, cutPaint, restPaint, gougePaint, sun;
  uniform mat3 toWorld;
  uniform float opacity, scale, colored;
  varying vec3 vView;
  varying float vRest, vCut, vGouge;
  void main() {
    vec3 n = toWorld * normalize(cross(dFdx(vView), dFdy(vView)));
    vec3 cut = mix(cutPaint, restPaint, colored * sqrt(clamp(vRest / scale, 0.0, 1.0)));
    vec3 paint = mix(stockPaint, cut, vCut);
    if (vGouge > 0.5 && colored > 0.5) paint = gougePaint;
    float diffuse = max(dot(n, sun), 0.0), sky = 0.5 + 0.5 * n.z;
    gl_FragColor = vec4(paint * (0.34 + 0.24 * sky + 0.55 * diffuse), opacity);
  }`;

function texture(array, columns, rows, format = THREE.RedFormat, type = THREE.FloatType) {
  const made = new THREE.DataTexture(array, columns, rows, format, type);
  made.unpackAlignment = 1;
  made.needsUpdate = true;
  return made;
}

export class StockMesh extends THREE.Mesh {
  // scale: so much left above the part has the full colour.
  constructor(stock, scale) {
    const {columns, rows} = stock, across = columns + 2, count = across * (rows + 2);
    const position = new Float32Array(3 * count);
    for (let v = 0; v < count; ++v) {
      position[3 * v] = v % across - 1;
      position[3 * v + 1] = Math.floor(v / across) - 1;
    }
    const index = new Uint32Array(6 * (across - 1) * (rows + 1));
    for (let row = 0, k = 0; row <= rows; ++row) {
      for (let column = 0; column + 1 < across; ++column, k += 6) {
        const a = row * across + column, b = a + across;
        index.set([a, a + 1, b + 1, a, b + 1, b], k);
      }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    const paint = () => ({value: new THREE.Color()}), of = array => ({value: texture(array, columns, rows)});
    const gouges = Uint8Array.from(stock.gouged, g => g ? 255 : 0);
    super(geometry, new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: THREE.DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 2,
      uniforms: {
        heights: of(stock.heights),
        parts: of(stock.part),
        starts: of(stock.before),
        gouges: {value: texture(gouges, columns, rows, THREE.RedFormat, THREE.UnsignedByteType)},
        first: {value: new THREE.Vector2(...stock.first)},
        cell: {value: stock.cell},
        bottom: {value: stock.bottom},
        scale: {value: scale},
        opacity: {value: 1},
        colored: {value: 1},
        stockPaint: paint(),
        cutPaint: paint(),
        restPaint: paint(),
        gougePaint: paint(),
        sun: {value: new THREE.Vector3(-0.55, 0.5, 0.78).normalize()},
        toWorld: {value: new THREE.Matrix3()},
      },
    }));
    this.frustumCulled = false;
    this.renderOrder = 1;
    this.onBeforeRender = (renderer, scene, camera) => this.uniforms.toWorld.value.setFromMatrix4(camera.matrixWorld);
  }

  get uniforms() { return this.material.uniforms; }

  // After the heights have changed.
  refresh() { this.uniforms.heights.value.needsUpdate = true; }

  setOpacity(opacity) {
    this.uniforms.opacity.value = opacity;
    this.material.transparent = opacity < 1;
  }

  setTheme(name) {
    const colors = PATH_COLORS[name];
    for (const paint of ['stock', 'cut', 'rest', 'gouge']) this.uniforms[paint + 'Paint'].value.set(colors[paint]);
  }
}
