/**
 * How the plane of the table looks in a picture of the scene: a projective map, written as the rows of a matrix that
 * takes (x, y, 1) to a place in the picture, up to a factor.
 */

/** @import { Point } from "pleat" */

/** @typedef {[number, number, number, number, number, number, number, number, number]} Projective */

/** @param {number[]} values */
const as9 = (values) => /** @type {Projective} */ (values);

/** @param {Projective} map @param {Point} p @returns {Point} */
export function applied([a, b, c, d, e, f, g, h, i], [x, y]) {
  const w = g * x + h * y + i;
  return [(a * x + b * y + c) / w, (d * x + e * y + f) / w];
}

/** First the second, then the first. @param {Projective} m @param {Projective} n @returns {Projective} */
export function after([a, b, c, d, e, f, g, h, i], [j, k, l, m, n, o, p, q, r]) {
  return as9([
    ...[a * j + b * m + c * p, a * k + b * n + c * q, a * l + b * o + c * r],
    ...[d * j + e * m + f * p, d * k + e * n + f * q, d * l + e * o + f * r],
    ...[g * j + h * m + i * p, g * k + h * n + i * q, g * l + h * o + i * r],
  ]);
}

/** The way back, up to a factor. @param {Projective} map @returns {Projective} */
export function back([a, b, c, d, e, f, g, h, i]) {
  return as9([
    ...[e * i - f * h, c * h - b * i, b * f - c * e],
    ...[f * g - d * i, a * i - c * g, c * d - a * f],
    ...[d * h - e * g, b * g - a * h, a * e - b * d],
  ]);
}

/** The plane turned and moved. @param {Point} at @param {number} turn @returns {Projective} */
export function laid([x, y], turn) {
  const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
  return [cos, -sin, x, sin, cos, y, 0, 0, 1];
}

/** As CSS writes it. @param {Projective} map */
export function asTransform(map) {
  const [a, b, c, d, e, f, g, h, i] = map.map((value) => value / map[8]);
  return `matrix3d(${[a, d, 0, g, b, e, 0, h, 0, 0, 1, 0, c, f, 0, i].join(",")})`;
}

/**
 * What of viser's page is looked at: three.js's camera, its picture, the node of the table's frame.
 * @typedef {object} Scene
 * @property {{projectionMatrix: Matrix, matrixWorldInverse: Matrix}} camera
 * @property {HTMLCanvasElement} canvas
 * @property {Record<string, {matrixWorld: Matrix}|undefined>} nodeRefFromName
 */
/** @typedef {{elements: number[], clone: () => Matrix, multiply: (other: Matrix) => Matrix}} Matrix */

/**
 * From the plane of the table (m) to the picture (px from the frame's top left), as the camera is now; null before there
 * is a scene.
 * @param {Partial<Scene>|undefined} scene
 * @param {number} height over the table at which the plane is (m)
 * @returns {Projective|null}
 */
export function tablePicture(scene, height) {
  const world = scene?.nodeRefFromName?.[""];
  if (!scene?.camera || !scene.canvas || !world) return null;
  const { projectionMatrix, matrixWorldInverse } = scene.camera;
  const { elements: m } = projectionMatrix.clone().multiply(matrixWorldInverse).multiply(world.matrixWorld);
  const { left, top, width, height: tall } = scene.canvas.getBoundingClientRect();
  /** @param {number} row @returns {[number, number, number]} */
  const row = (row) => [m[row], m[4 + row], height * m[8 + row] + m[12 + row]];
  const [x, y, w] = [row(0), row(1), row(3)];
  const across = x.map((value, n) => (width / 2) * value + (left + width / 2) * w[n]);
  const down = y.map((value, n) => (-tall / 2) * value + (top + tall / 2) * w[n]);
  return as9([...across, ...down, ...w]);
}
