// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The picture: surfaces in their box, camera and light.
import * as THREE from './three.module.js';
import { GLTFExporter } from './GLTFExporter.js';
import { boxEdges, planeEdges } from './box.js';
import { Camera } from './camera.js';
import { colourOf, coloursOf } from './colours.js';
import { diagonalOf } from './state.js';

const axes = ['x', 'y', 'z'];

/** A letter that faces the reader. */
function letter(text, colour) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 64;
  const context = canvas.getContext('2d');
  context.font = '48px system-ui, "DejaVu Sans", sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillStyle = colour;
  context.fillText(text, 32, 32);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  return new THREE.Sprite(new THREE.SpriteMaterial({ map }));
}

/** Of several surfaces the one of the smallest extent; nothing of none. */
function smallest(parts) {
  let found = null;
  let least = Infinity;
  for (const part of parts) {
    const box = new THREE.Box3().setFromArray(part.positions);
    const extent = parts.length > 1 && !box.isEmpty() ? box.getSize(new THREE.Vector3()).length() : Infinity;
    if (!found || extent < least) [found, least] = [part, extent];
  }
  return found;
}

/** A circle that faces the reader, also where the surface hides its centre. */
function circle({ centre, radius }, color) {
  const line = new THREE.LineLoop(
    new THREE.BufferGeometry().setFromPoints(new THREE.Path().absarc(0, 0, radius).getPoints(96)),
    new THREE.LineBasicMaterial({ color, depthTest: false }));
  line.position.set(...centre);
  line.onBeforeRender = (renderer, scene, camera) => {
    line.quaternion.copy(camera.quaternion);
    line.updateMatrixWorld();
    line.modelViewMatrix.multiplyMatrices(camera.matrixWorldInverse, line.matrixWorld);
  };
  line.renderOrder = 1;
  return line;
}

export class Stage {
  #canvas;
  #renderer;
  #scene = new THREE.Scene();
  #camera;
  #parts = new THREE.Group();
  #frame = new THREE.Group();
  #box = [[0, 0, 0], [1, 1, 1]];
  #plane = null;
  #lens = null;
  #scheme = '';
  #ground = colourOf('stage');
  #due = false;
  #raycaster = new THREE.Raycaster();

  /** moved: called when the reader has turned or moved the picture */
  constructor(canvas, moved) {
    this.#canvas = canvas;
    this.#renderer = new THREE.WebGLRenderer({
      canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.#camera = new Camera(canvas, () => this.draw(), moved);
    this.#scene.add(
      ...this.#camera.objects, new THREE.AmbientLight(0xffffff, 1.4), this.#parts, this.#frame);
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.#paint());
  }

  /** The domain: drawn as the edges of a box, with letters at its axes. */
  setBox(box) {
    this.#box = box;
    this.#camera.box = box;
    this.#drawFrame();
  }

  /** The plane of a slice, { point, normal }, whose edge is drawn, or null. */
  setPlane(plane) {
    if (JSON.stringify(plane) === JSON.stringify(this.#plane)) return;
    this.#plane = plane;
    this.#drawFrame();
  }

  /** The lens, { centre, radius }, drawn as a circle around it, or null. */
  setLens(lens) {
    if (JSON.stringify(lens) === JSON.stringify(this.#lens)) return;
    this.#lens = lens;
    this.#drawFrame();
    this.draw();
  }

  #drawFrame() {
    for (const object of this.#frame.children) {
      object.geometry?.dispose();
      object.material.map?.dispose();
      object.material.dispose();
    }
    this.#frame.clear();
    const [low, high] = this.#box;
    const quiet = colourOf('quiet', this.#scheme);
    const lines = (points, opacity) => this.#frame.add(new THREE.LineSegments(
      new THREE.BufferGeometry().setFromPoints(points),
      new THREE.LineBasicMaterial({ color: quiet, transparent: true, opacity })));
    lines(boxEdges(this.#box).flat(), 0.5);
    if (this.#plane) lines(planeEdges(this.#box, this.#plane), 1);
    if (this.#lens) this.#frame.add(circle(this.#lens, colourOf('accent', this.#scheme)));
    const step = 0.035 * diagonalOf(this.#box);
    axes.forEach((text, d) => {
      const sprite = letter(text, quiet);
      const at = [...low];
      at[d] = (low[d] + high[d]) / 2;
      at[(d + 1) % 3] -= step;
      at[(d + 2) % 3] -= step;
      sprite.position.set(...at);
      sprite.scale.setScalar(1.4 * step);
      this.#frame.add(sprite);
    });
  }

  /** Where the reader stands: camera.js. */
  get view() {
    return this.#camera;
  }

  /** Looks at the whole box, or takes [position, target, up] of the address. */
  look(camera) {
    if (camera) this.#camera.view = camera;
    else this.#camera.lookFrom();
    this.draw();
  }

  get camera() {
    return this.#camera.view;
  }

  /** The direction to the reader. */
  get towardsReader() {
    return this.#camera.towardsReader;
  }

  /** Replaces the surfaces by those of a frame. The ends of the colours are null where nothing has one. */
  show(frame, least, greatest) {
    for (const part of this.#parts.children) {
      part.geometry.dispose();
      part.material.dispose();
    }
    this.#parts.clear();
    const isosurfaces = frame.parts.filter((part) => part.kind === 'isosurface');
    const colours = { least, greatest, several: isosurfaces.length > 1 };
    const innermost = smallest(isosurfaces);
    for (const part of frame.parts) {
      const opens = innermost && part !== innermost && (part.kind === 'boundary' || part.kind === 'isosurface');
      this.#parts.add(this.#object(part, { ...colours, opacity: opens ? 0.35 : 1 }));
    }
    this.draw();
  }

  #object(part, colours) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(part.positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(part.indices, 1));
    const object = this.#drawn(part, geometry, colours);
    // Spares the search for a sphere around the surface, once a frame.
    object.frustumCulled = false;
    object.userData = { kind: part.kind, isovalue: part.isovalue ?? null };
    return object;
  }

  /** colours: their ends; whether there are several isosurfaces, which have those of their values; opacity,
      1 for what hides what is behind it */
  #drawn(part, geometry, { least, greatest, several, opacity }) {
    if (part.kind === 'outlines' || part.kind === 'isolines') {
      return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({
        color: colourOf('outline', this.#scheme), transparent: true, opacity: part.kind === 'isolines' ? 1 : 0.55,
        userData: { colour: 'outline' } }));
    }
    const look = {
      side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    if (part.values) {
      const colours = coloursOf(part.values, least, greatest);
      geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
      geometry.setAttribute('value', new THREE.BufferAttribute(part.values, 1));
      look.vertexColors = true;
    } else if (several) {
      look.color = new THREE.Color(...coloursOf([part.isovalue], least, greatest));
    } else {
      look.color = new THREE.Color(colourOf('surface', this.#scheme));
      look.userData = { colour: 'surface' };
    }
    if (opacity < 1) Object.assign(look, { transparent: true, opacity, depthWrite: false });
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
    this.#raycaster.setFromCamera(at, this.#camera.three);
    // Nothing is behind the reader of a parallel view.
    if (this.#camera.isParallel) {
      this.#raycaster.ray.recast(-20 * diagonalOf(this.#box));
    }
    const meshes = this.#parts.children.filter(({ isMesh, material, userData: { kind } }) => (
      isMesh && !(kind === 'boundary' && material.transparent)));
    const hit = this.#raycaster.intersectObjects(meshes, false)[0];
    if (!hit) return null;
    const value = hit.object.geometry.getAttribute('value');
    const found = { point: [...hit.point], kind: hit.object.userData.kind, value: hit.object.userData.isovalue };
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
    this.#renderer.setClearColor(this.#ground, 1);
    this.#renderer.render(this.#scene, this.#camera.three);
  }

  /**
   * The picture in another size, drawn by parts that every graphics card holds.
   * ground: a colour, or null for none; scheme: of the lines and surfaces, 'light' or 'dark'
   * frame: whether box and letters are drawn
   * returns a canvas
   */
  drawSized(width, height, { ground, scheme, frame }) {
    const canvas = document.createElement('canvas');
    Object.assign(canvas, { width, height });
    const context = canvas.getContext('2d');
    const ratio = this.#renderer.getPixelRatio();
    const most = 2048;
    this.#renderer.setPixelRatio(1);
    this.#paint(scheme);
    this.#frame.visible = frame;
    this.#renderer.setClearColor(ground ?? '#000', ground ? 1 : 0);
    for (let y = 0; y < height; y += most) {
      for (let x = 0; x < width; x += most) {
        const part = [Math.min(most, width - x), Math.min(most, height - y), x, y];
        this.#renderer.setSize(part[0], part[1], false);
        this.#camera.drawPart([width, height], part,
          () => this.#renderer.render(this.#scene, this.#camera.three));
        context.drawImage(this.#canvas, x, y);
      }
    }
    this.#frame.visible = true;
    this.#renderer.setPixelRatio(ratio);
    this.#paint('');
    this.#resize();
    return canvas;
  }

  /** Gives lines, letters and surfaces without values the colours of a scheme. */
  #paint(scheme = this.#scheme) {
    this.#scheme = scheme;
    this.#ground = colourOf('stage', scheme);
    this.#drawFrame();
    for (const { material } of this.#parts.children) {
      const { colour } = material.userData;
      if (colour) material.color.set(colourOf(colour, scheme));
    }
    this.draw();
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
    this.drawNow();
  }
}
