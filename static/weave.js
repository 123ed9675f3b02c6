/**
 * Gives the cloth of the 3D view threads: this runs in the frame, inside viser's page, and in recordings.
 *
 * viser's meshes have one colour. Where each corner of the cloth lies in the pattern, a mesh that nobody sees says
 * (`app/ui/cloth_view.py`): its vertices are lent to both faces, and their colour follows warp and weft. Threads finer
 * than a picture point are left out, so from afar only broad bands of uneven threads are seen.
 *
 * @typedef {{count: number}} Places
 * @typedef {{attributes: Record<string, Places>, setAttribute: (name: string, places: Places) => void,
 *   deleteAttribute: (name: string) => void, computeBoundingSphere: () => void}} Geometry
 * @typedef {{vertexShader: string, fragmentShader: string}} Shader
 * @typedef {{onBeforeCompile: (shader: Shader) => void, needsUpdate: boolean}} Material
 * @typedef {{isMesh?: boolean, geometry?: Geometry, material?: Material}} Part
 * @typedef {{traverse: (see: (part: Part) => void) => void}} Branch
 */

const LOOK_MS = 250;

const FACES = ["/cloth/front", "/cloth/back"];
const PATTERN = "/cloth/pattern";

/** Replaces parts of three's own shaders. Lengths in metres: threads of 1 mm, uneven in bands of 3 and of 8 mm. */
const CORNER = ["#include <common>", "#include <common>\nattribute vec3 pattern;\nvarying vec2 vPattern;"];
const PLACE = ["#include <begin_vertex>", "#include <begin_vertex>\nvPattern = pattern.xy;"];
const THREADS = [
  "#include <common>",
  `#include <common>
varying vec2 vPattern;
float chance(float n) { return fract(sin(n * 12.9898) * 43758.5453); }
float tone(float thread, float along) {
  float from = chance(thread + 57.0 * floor(along)), to = chance(thread + 57.0 * floor(along + 1.0));
  return 2.0 * mix(from, to, smoothstep(0.0, 1.0, fract(along))) - 1.0;
}
float shown(vec2 threads) {
  vec2 px = fwidth(threads);
  return 1.0 - smoothstep(0.4, 1.2, max(px.x, px.y));
}
float uneven(vec2 place, float width) {
  vec2 threads = place / width, along = place / (20.0 * width);
  return shown(threads) * (tone(floor(threads.x), along.y) + tone(floor(threads.y) + 311.0, along.x));
}
float woven(vec2 place) {
  vec2 threads = place / 0.001;
  float over = shown(threads) * sin(3.14159 * threads.x) * sin(3.14159 * threads.y);
  return 1.0 + 0.12 * over + 0.055 * (uneven(place, 0.003) + uneven(place, 0.008));
}`,
];
const COLOUR = ["#include <color_fragment>", "#include <color_fragment>\ndiffuseColor.rgb *= woven(vPattern);"];

/** @param {Shader} shader */
function weave(shader) {
  for (const [from, to] of [CORNER, PLACE]) shader.vertexShader = shader.vertexShader.replace(from, to);
  for (const [from, to] of [THREADS, COLOUR]) shader.fragmentShader = shader.fragmentShader.replace(from, to);
}

/** @param {string} name @returns {Part|null} */
function mesh(name) {
  /** @type {Part|null} */
  let found = null;
  const scene = /** @type {{__viserMutable?: {nodeRefFromName: Record<string, Branch|null>}}} */ (window).__viserMutable;
  scene?.nodeRefFromName[name]?.traverse((part) => {
    if (part.isMesh) found ??= part;
  });
  return found;
}

/** Lends the pattern's vertices to the faces that have as many. */
function lend() {
  const places = mesh(PATTERN)?.geometry?.attributes.position;
  for (const geometry of FACES.map((name) => mesh(name)?.geometry)) {
    if (!geometry || !places || geometry.attributes.pattern === places) continue;
    if (geometry.attributes.position?.count === places.count) geometry.setAttribute("pattern", places);
    else geometry.deleteAttribute("pattern");
  }
}

/** @type {WeakSet<Geometry>} */
const followed = new WeakSet();

/** Lends again as soon as viser has given a geometry other vertices. @param {Geometry} geometry */
function follow(geometry) {
  if (followed.has(geometry)) return;
  followed.add(geometry);
  const bound = geometry.computeBoundingSphere.bind(geometry);
  geometry.computeBoundingSphere = () => {
    bound();
    lend();
  };
}

setInterval(() => {
  for (const name of [...FACES, PATTERN]) {
    const { geometry, material } = mesh(name) ?? {};
    if (!geometry || !material) continue;
    follow(geometry);
    if (name === PATTERN || material.onBeforeCompile === weave) continue;
    material.onBeforeCompile = weave;
    material.needsUpdate = true;
  }
  lend();
}, LOOK_MS);
