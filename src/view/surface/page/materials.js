// How things are lit: own shaders, since software rendering is slow with three's.

import * as THREE from 'three';

const SUN = new THREE.Vector3(-0.55, 0.5, 0.78).normalize();  // from the north-west, as maps have it

// Light and paint. Patches are lit at their vertices, of which curved ones have many;
// the ground by the slope of each triangle.
const LIGHT = `
  uniform vec3 planePaint, cylinderPaint, spherePaint, wallPaint, plainPaint, sun;
  uniform float relief, kinds;
  vec3 lit(vec3 share, vec3 n, vec3 toEye) {
    vec3 paint = planePaint * (1.0 - share.r - share.g - share.b) + cylinderPaint * share.r + spherePaint * share.g
      + wallPaint * share.b;
    paint = mix(plainPaint, paint, kinds);
    // Flat country is lit as if it were steeper.
    n = normalize(vec3(n.xy * relief, n.z));
    float diffuse = max(dot(n, sun), 0.0), sky = 0.5 + 0.5 * n.z;
    float shine = pow(max(dot(n, normalize(sun + toEye)), 0.0), 32.0);
    return paint * (0.30 + 0.22 * sky + 0.62 * diffuse) + 0.07 * shine;
  }`;

const VERTEX = `
  attribute vec4 mix4;
  uniform mat3 toWorld;
  varying vec3 vColor;
  varying vec3 vView;
  ${LIGHT}
  #include <clipping_planes_pars_vertex>
  void main() {
    vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  #ifdef FACETS
    vView = mvPosition.xyz;
  #else
    vColor = lit(mix4.rgb, normal, normalize(toWorld * -mvPosition.xyz));
  #endif
    gl_Position = projectionMatrix * mvPosition;
    #include <clipping_planes_vertex>
  }`;

const FRAGMENT = `
  uniform float opacity;
  uniform mat3 toWorld;
  varying vec3 vColor;
  varying vec3 vView;
  #ifdef FACETS
  ${LIGHT}
  #endif
  #include <clipping_planes_pars_fragment>
  void main() {
    #include <clipping_planes_fragment>
  #ifdef FACETS
    vec3 n = toWorld * normalize(cross(dFdx(vView), dFdy(vView)));
    gl_FragColor = vec4(lit(vec3(0.0), n, normalize(toWorld * -vView)), opacity);
  #else
    gl_FragColor = vec4(vColor, opacity);
  #endif
  }`;

const color = text => new THREE.Color(text);

export function surfaceMaterial(planes, facets = false) {
  return new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: THREE.DoubleSide,
    clipping: true,
    clippingPlanes: planes,
    defines: facets ? {FACETS: 1} : {},
    // Lines that lie in the surface come out in front of it.
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 2,
    uniforms: {
      planePaint: {value: color('#fff')},
      cylinderPaint: {value: color('#fff')},
      spherePaint: {value: color('#fff')},
      wallPaint: {value: color('#fff')},
      plainPaint: {value: color('#fff')},
      sun: {value: SUN},
      relief: {value: 1},
      opacity: {value: 1},
      kinds: {value: 1},
      toWorld: {value: new THREE.Matrix3()},
    },
  });
}

// paints: { plane, cylinder, sphere, wall, plain }
export function setPaints(material, paints) {
  for (const [name, text] of Object.entries(paints)) material.uniforms[name + 'Paint'].value.set(text);
}

export function setOpacity(material, opacity) {
  material.uniforms.opacity.value = opacity;
  material.transparent = opacity < 1;
}

// A translucent body that is brighter at its outline.
export function glassMaterial() {
  return new THREE.ShaderMaterial({
    transparent: true,
    depthWrite: false,
    side: THREE.FrontSide,
    uniforms: {color: {value: color('#fff')}, rim: {value: color('#fff')}},
    vertexShader: `
      varying vec3 vNormal, vView;
      void main() {
        vec4 p = modelViewMatrix * vec4(position, 1.0);
        vNormal = normalize(normalMatrix * normal);
        vView = p.xyz;
        gl_Position = projectionMatrix * p;
      }`,
    fragmentShader: `
      uniform vec3 color, rim;
      varying vec3 vNormal, vView;
      void main() {
        float facing = abs(dot(normalize(vNormal), normalize(vView)));
        float edge = pow(1.0 - facing, 2.0);
        float lit = 0.75 + 0.25 * normalize(vNormal).y;
        gl_FragColor = vec4(mix(color * lit, rim, edge), 0.28 + 0.62 * edge);
      }`,
  });
}
