// The tool as a body of revolution, its tip at the origin.

import * as THREE from 'three';

import {PATH_COLORS} from './colors.js';

const ACROSS = 48, STEPS = 24;

export class ToolMesh extends THREE.Mesh {
  // height: of the tool with its shank.
  constructor(tool, height) {
    const outline = [new THREE.Vector2(0, 0)];
    if (tool.flat > 0) outline.push(new THREE.Vector2(tool.flat, 0));
    for (let k = 1; k <= STEPS && tool.corner > 0; ++k) {
      const out = tool.flat + (tool.cornerEnd - tool.flat) * Math.sin(k / STEPS * Math.PI / 2);
      outline.push(new THREE.Vector2(out, tool.height(out)));
    }
    if (tool.cornerEnd < tool.radius) outline.push(new THREE.Vector2(tool.radius, tool.height(tool.radius)));
    outline.push(new THREE.Vector2(tool.radius, height), new THREE.Vector2(0, height));
    super(new THREE.LatheGeometry(outline, ACROSS).rotateX(Math.PI / 2), new THREE.ShaderMaterial({
      side: THREE.DoubleSide,
      transparent: true,
      uniforms: {color: {value: new THREE.Color()}, shine: {value: new THREE.Color()}},
      vertexShader: `
        varying vec3 vNormal, vView;
        void main() {
          vec4 p = modelViewMatrix * vec4(position, 1.0);
          vNormal = normalize(normalMatrix * normal);
          vView = p.xyz;
          gl_Position = projectionMatrix * p;
        }`,
      fragmentShader: `
        uniform vec3 color, shine;
        varying vec3 vNormal, vView;
        void main() {
          float facing = abs(dot(normalize(vNormal), normalize(vView)));
          float gleam = pow(abs(dot(normalize(vNormal), normalize(vec3(-0.5, 0.45, 0.74)))), 12.0);
          gl_FragColor = vec4(mix(color * (0.45 + 0.55 * facing), shine, 0.45 * gleam), 0.88);
        }`,
    }));
    this.frustumCulled = false;
    this.renderOrder = 8;
  }

  setTheme(name) {
    this.material.uniforms.color.value.set(PATH_COLORS[name].tool);
    this.material.uniforms.shine.value.set(PATH_COLORS[name].shine);
  }
}
