// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the reader stands: turned, moved and zoomed by hand, by keys and by buttons, in perspective or
// parallel projection.
//
// Invariant: both projections show the plane through the target alike, so that one position, target
// and direction up describe the view in either.
import * as THREE from './three.module.js';
import { OrbitControls } from './OrbitControls.js';
import { diagonalOf } from './state.js';

const fieldOfView = 35;
/** The height of what is seen at the target, from a distance of 1. */
const heightAtOne = 2 * Math.tan(((fieldOfView / 2) * Math.PI) / 180);

export class Camera {
  #perspective = new THREE.PerspectiveCamera(fieldOfView, 1, 0.01, 100);
  #parallel = new THREE.OrthographicCamera();
  #now = this.#perspective;
  #orbit;
  #lamp = new THREE.DirectionalLight(0xffffff, 2.2);
  #box = [[0, 0, 0], [1, 1, 1]];
  #aspect = 1;

  /** changed: the view is another one; moved: the reader's hand has ended */
  constructor(canvas, changed, moved) {
    for (const camera of [this.#perspective, this.#parallel]) camera.up.set(0, 0, 1);
    this.#orbit = new OrbitControls(this.#now, canvas);
    this.#orbit.addEventListener('change', changed);
    this.#orbit.addEventListener('end', moved);
    this.#lamp.position.set(-0.4, 0.6, 1);
    this.#now.add(this.#lamp);
  }

  /** What the scene has to hold. */
  get objects() {
    return [this.#perspective, this.#parallel];
  }
  get three() {
    return this.#now;
  }
  get isParallel() {
    return this.#now === this.#parallel;
  }
  get target() {
    return this.#orbit.target;
  }

  set box(box) {
    this.#box = box;
    const diagonal = diagonalOf(box);
    this.#perspective.near = diagonal / 1000;
    this.#perspective.far = diagonal * 100;
    // A parallel view has no place from where it looks: nothing is behind it.
    this.#parallel.near = -diagonal * 20;
    this.#parallel.far = diagonal * 20;
    this.#fit();
  }

  set aspect(aspect) {
    this.#aspect = aspect;
    this.#fit();
  }

  /** 'perspective' or 'parallel' */
  set projection(projection) {
    const next = projection === 'parallel' ? this.#parallel : this.#perspective;
    if (next === this.#now) return;
    const view = this.view;
    this.#now = next;
    this.#now.add(this.#lamp);
    this.#orbit.object = next;
    this.view = view;
  }

  /** [position, target, up] as nine numbers. */
  get view() {
    const { target } = this.#orbit;
    const position = this.#now.position.clone();
    if (this.isParallel) position.sub(target).divideScalar(this.#parallel.zoom).add(target);
    return [...position, ...target, ...this.#now.up];
  }
  set view(view) {
    this.#now.position.set(...view.slice(0, 3));
    this.#orbit.target.set(...view.slice(3, 6));
    this.#now.up.set(...view.slice(6, 9));
    this.#parallel.zoom = 1;
    this.#fit();
    this.#orbit.update();
    this.#now.updateMatrixWorld();
  }

  /** Looks at the whole box, with its letters, from a direction. */
  lookFrom(direction = [0.55, -0.75, 0.4]) {
    const [low, high] = this.#box;
    const centre = low.map((x, d) => (x + high[d]) / 2);
    const towards = new THREE.Vector3(...direction).normalize();
    const right = new THREE.Vector3(0, 0, 1).cross(towards).normalize();
    const up = towards.clone().cross(right);
    const half = (0.95 * heightAtOne) / 2;
    const margin = 0.06 * diagonalOf(this.#box);
    // The distance from which each corner lies inside the picture.
    let distance = 0;
    for (let bits = 0; bits < 8; ++bits) {
      const corner = new THREE.Vector3(
        ...low.map((x, d) => (bits >> d & 1 ? high[d] : x - margin) - centre[d]));
      const beside = Math.max(
        Math.abs(corner.dot(right)) / this.#aspect, Math.abs(corner.dot(up))) / half;
      distance = Math.max(distance, beside + (this.isParallel ? 0 : corner.dot(towards)));
    }
    const position = towards.multiplyScalar(distance).toArray().map((x, d) => x + centre[d]);
    this.view = [...position, ...centre, 0, 0, 1];
  }

  /** Turns by angles, to the right and upwards, as the surface turns. */
  turn(right, up) {
    this.#orbit.rotateLeft(right);
    this.#orbit.rotateUp(-up);
  }

  /** Moves the picture by points of the screen. */
  move(right, down) {
    this.#orbit.pan(right, down);
  }

  /** Above 1: nearer. */
  zoom(factor) {
    this.#orbit.dollyIn(1 / factor);
  }

  /** The direction to the reader. */
  get towardsReader() {
    return [...this.#now.position.clone().sub(this.target).normalize()];
  }

  /** How high what is seen at the depth of the target is. */
  get heightAtTarget() {
    const distance = this.#now.position.distanceTo(this.target);
    return (heightAtOne * distance) / (this.isParallel ? this.#parallel.zoom : 1);
  }

  /** Draws by another shape of picture; `part`, [width, height, x, y] in a whole of [width, height]. */
  drawPart(whole, part, draw) {
    const [width, height] = whole;
    const before = this.#aspect;
    this.aspect = width / height;
    this.#now.setViewOffset(width, height, part[2], part[3], part[0], part[1]);
    draw();
    this.#now.clearViewOffset();
    this.aspect = before;
  }

  #fit() {
    this.#perspective.aspect = this.#aspect;
    const half = (heightAtOne * this.#parallel.position.distanceTo(this.target)) / 2;
    Object.assign(this.#parallel, {
      top: half, bottom: -half, right: half * this.#aspect, left: -half * this.#aspect });
    for (const camera of this.objects) camera.updateProjectionMatrix();
  }
}
