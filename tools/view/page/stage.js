// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The picture: surfaces in their box, camera and light.
import * as THREE from './three.module.js';
import { OrbitControls } from './OrbitControls.js';
import { GLTFExporter } from './GLTFExporter.js';
import { colourAt, coloursOf } from './colours.js';
import { diagonalOf } from './state.js';

const cssColour = (name) => new THREE.Color(
  getComputedStyle(document.documentElement).getPropertyValue(name).trim());

/** A letter that faces the reader. */
function letter(text, colour) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 64;
  const context = canvas.getContext('2d');
  context.font = '48px system-ui, "DejaVu Sans", sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillStyle = `#${colour.getHexString()}`;
  context.fillText(text, 32, 32);
  return new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas) }));
}

export class Stage {
  #canvas;
  #renderer;
  #scene = new THREE.Scene();
  #camera = new THREE.PerspectiveCamera(35, 1, 0.01, 100);
  #controls;
  #parts = new THREE.Group();
  #frame = new THREE.Group();
  #box = [[0, 0, 0], [1, 1, 1]];
  #due = false;
  #raycaster = new THREE.Raycaster();

  /** moved: called when the reader has turned or moved the picture */
  constructor(canvas, moved) {
    this.#canvas = canvas;
    this.#renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.#camera.up.set(0, 0, 1);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.addEventListener('change', () => this.draw());
    this.#controls.addEventListener('end', moved);
    const lamp = new THREE.DirectionalLight(0xffffff, 2.6);
    lamp.position.set(-0.6, 0.9, 1);
    this.#camera.add(lamp);
    this.#scene.add(this.#camera, new THREE.AmbientLight(0xffffff, 1.1), this.#parts, this.#frame);
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
      this.setBox(this.#box);
      this.draw();
    });
  }

  /** The domain: drawn as the edges of a box, with letters at its axes. */
  setBox(box) {
    this.#box = box;
    const diagonal = diagonalOf(box);
    this.#camera.near = diagonal / 1000;
    this.#camera.far = diagonal * 100;
    this.#camera.updateProjectionMatrix();
    this.#frame.clear();
    const size = new THREE.Vector3(...box[1]).sub(new THREE.Vector3(...box[0]));
    const edges = new THREE.LineSegments(
      new THREE.EdgesGeometry(new THREE.BoxGeometry(size.x, size.y, size.z)),
      new THREE.LineBasicMaterial({
        color: cssColour('--quiet'), transparent: true, opacity: 0.35 }));
    edges.position.set(...box[0]).addScaledVector(size, 0.5);
    this.#frame.add(edges);
    const step = 0.035 * diagonalOf(box);
    ['x', 'y', 'z'].forEach((text, d) => {
      const sprite = letter(text, cssColour('--quiet'));
      const at = [...box[0]];
      at[d] = (box[0][d] + box[1][d]) / 2;
      at[(d + 1) % 3] -= step;
      at[(d + 2) % 3] -= step;
      sprite.position.set(...at);
      sprite.scale.setScalar(1.4 * step);
      this.#frame.add(sprite);
    });
  }

  /** Looks at the whole box, or takes [position, target, up] of the address. */
  look(camera) {
    if (camera) {
      this.#camera.position.set(...camera.slice(0, 3));
      this.#controls.target.set(...camera.slice(3, 6));
      this.#camera.up.set(...camera.slice(6, 9));
    } else {
      const centre = this.#box[0].map((x, d) => (x + this.#box[1][d]) / 2);
      this.#controls.target.set(...centre);
      this.#camera.up.set(0, 0, 1);
      const narrow = Math.min(1, this.#camera.aspect);
      this.#camera.position.set(...centre)
        .addScaledVector(new THREE.Vector3(0.55, -0.75, 0.4).normalize(), 1.75 * diagonalOf(this.#box) / narrow);
    }
    this.#camera.updateProjectionMatrix();
    this.#controls.update();
  }

  get camera() {
    return [...this.#camera.position, ...this.#controls.target, ...this.#camera.up];
  }

  /** The direction to the reader. */
  get towardsReader() {
    return [...this.#camera.position.clone().sub(this.#controls.target).normalize()];
  }

  /** Whether dragging turns the picture. */
  set turns(on) {
    this.#controls.enabled = on;
  }

  /** Replaces the surfaces by those of a frame. The ends of the colours, and the isovalue, may be null. */
  show(frame, isovalue, least, greatest) {
    for (const part of this.#parts.children) {
      part.geometry.dispose();
      part.material.dispose();
    }
    this.#parts.clear();
    for (const part of frame.parts) this.#parts.add(this.#object(part, isovalue, least, greatest));
    this.draw();
  }

  #object(part, isovalue, least, greatest) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(part.positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(part.indices, 1));
    const object = this.#drawn(part, geometry, isovalue, least, greatest);
    // Spares the search for a sphere around the surface, once a frame.
    object.frustumCulled = false;
    object.userData = { kind: part.kind };
    return object;
  }

  #drawn(part, geometry, isovalue, least, greatest) {
    if (part.kind === 'outlines') {
      return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({
        color: cssColour('--text'), transparent: true, opacity: 0.45 }));
    }
    const look = {
      side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    if (part.values) {
      const colours = coloursOf(part.values, least, greatest);
      geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
      geometry.setAttribute('value', new THREE.BufferAttribute(part.values, 1));
      look.vertexColors = true;
    } else {
      const place = greatest > least && isovalue !== null ? (isovalue - least) / (greatest - least) : 0.5;
      const [r, g, b] = colourAt(place).map((c) => c / 255);
      look.color = new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace);
    }
    // A slice has no normals: its colours are those of the legend, without light.
    if (!part.normals) return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(look));
    geometry.setAttribute('normal', new THREE.BufferAttribute(part.normals, 4, true));
    return new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ ...look, roughness: 0.65 }));
  }

  /** What lies under a place of the window: its point, kind and value, or null. */
  pick(clientX, clientY) {
    const rectangle = this.#canvas.getBoundingClientRect();
    const at = new THREE.Vector2(
      2 * (clientX - rectangle.left) / rectangle.width - 1,
      1 - 2 * (clientY - rectangle.top) / rectangle.height);
    this.#raycaster.setFromCamera(at, this.#camera);
    const meshes = this.#parts.children.filter((part) => part.isMesh);
    const hit = this.#raycaster.intersectObjects(meshes, false)[0];
    if (!hit) return null;
    const value = hit.object.geometry.getAttribute('value');
    const found = { point: [...hit.point], kind: hit.object.userData.kind, value: null };
    if (value) {
      const corners = ['a', 'b', 'c'].map((k) => hit.face[k]);
      const x = corners.map((i) => new THREE.Vector3().fromBufferAttribute(
        hit.object.geometry.getAttribute('position'), i));
      const weights = THREE.Triangle.getBarycoord(hit.point, ...x, new THREE.Vector3());
      if (weights) {
        found.value = corners.reduce((sum, i, k) => sum + value.getX(i) * weights.getComponent(k), 0);
      }
    }
    return found;
  }

  /** Draws when the browser next has time. */
  draw() {
    if (this.#due) return;
    this.#due = true;
    requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    this.#due = false;
    this.#renderer.setClearColor(cssColour('--stage'));
    this.#renderer.render(this.#scene, this.#camera);
  }

  /** The surfaces as binary glTF, in one buffer. */
  async gltf() {
    const group = new THREE.Group();
    for (const part of this.#parts.children) {
      const copy = part.clone();
      copy.name = part.userData.kind;
      copy.geometry = part.geometry.clone();
      copy.geometry.deleteAttribute('value');
      const normals = copy.geometry.getAttribute('normal');
      if (normals) {
        const float = new Float32Array(3 * normals.count);
        for (let i = 0; i < normals.count; ++i) {
          new THREE.Vector3().fromBufferAttribute(normals, i).normalize().toArray(float, 3 * i);
        }
        copy.geometry.setAttribute('normal', new THREE.BufferAttribute(float, 3));
      }
      group.add(copy);
    }
    return new GLTFExporter().parseAsync(group, { binary: true });
  }

  #resize() {
    const { clientWidth, clientHeight } = this.#canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.#renderer.setSize(clientWidth, clientHeight, false);
    this.#camera.aspect = clientWidth / clientHeight;
    this.#camera.updateProjectionMatrix();
    this.drawNow();
  }
}
