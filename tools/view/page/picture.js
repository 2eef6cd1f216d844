// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The picture with its legend, the value at the cursor, the numbers, and what can be saved: the same
// wherever surfaces come from.
import { readable, readableCount } from './colours.js';
import { drawBar, markLegend, pictureWithLegend } from './legend.js';
import { Stage } from './stage.js';

const byId = (id) => document.getElementById(id);

export function showMessage(text) {
  byId('message').textContent = text;
  byId('message').hidden = text === '';
}

/** Shows the numbers of a picture. rows: [id, name, text, what it means] */
export function showNumbers(rows) {
  byId('numbers').replaceChildren(...rows.flatMap(([id, name, text, title]) => {
    const term = document.createElement('dt');
    term.textContent = name;
    if (title) term.title = title;
    const number = document.createElement('dd');
    number.id = `number-${id}`;
    number.textContent = text;
    return [term, number];
  }));
}

function download(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export class Picture {
  #stage;
  #title = '';
  #frame = null;
  #scale = null;

  /**
   * moved: called when the reader has turned or moved the picture
   * reset: called when the reader has asked for the view of the beginning
   * hovered, clicked: called with what lies there (Stage.pick), or with null
   */
  constructor({ moved, reset, hovered = () => {}, clicked = () => {} }) {
    this.#stage = new Stage(byId('canvas'), moved);
    this.#followCursor(hovered, clicked);
    byId('screenshot').addEventListener('click', () => this.#savePicture());
    byId('gltf').addEventListener('click', () => this.#saveModel());
    byId('reset').addEventListener('click', () => {
      this.#stage.look(null);
      this.#stage.draw();
      reset();
    });
  }

  get stage() {
    return this.#stage;
  }

  setTitle(title) {
    this.#title = title;
    document.title = `${title} – nestgrid`;
    byId('title').textContent = title;
  }

  /**
   * Shows a frame.
   * scale: { field, its name; least, greatest, the ends of the colours, null where nothing has one;
   *   isovalue, null where the surface has none; marked, whether the legend marks it; bound, of the error,
   *   null where it is not known }
   */
  show(frame, scale) {
    const { field, least, greatest, isovalue, marked } = scale;
    if (field !== this.#scale?.field) drawBar(field);
    byId('legend').hidden = least === null;
    if (least !== null) markLegend(least, greatest, marked ? isovalue : null);
    this.#stage.show(frame, isovalue, least, greatest);
    this.#frame = frame;
    this.#scale = scale;
  }

  #followCursor(hovered, clicked) {
    const canvas = byId('canvas');
    let last = null;
    const look = () => {
      const event = last;
      last = null;
      if (!event || event.buttons !== 0 || !this.#frame) return;
      const hit = this.#stage.pick(event.clientX, event.clientY);
      this.#tell(hit);
      hovered(hit);
    };
    canvas.addEventListener('pointermove', (event) => {
      if (!last) requestAnimationFrame(look);
      last = event;
    });
    canvas.addEventListener('pointerleave', () => this.#tell(null));
    canvas.addEventListener('pointerdown', () => { byId('hint').hidden = true; }, { once: true });
    canvas.addEventListener('click', (event) => {
      if (this.#frame) clicked(this.#stage.pick(event.clientX, event.clientY));
    });
  }

  #tell(hit) {
    const place = hit ? ['x', 'y', 'z'].map((axis, d) => `${axis} ${readable(hit.point[d])}`) : [];
    let text = place.join('   ');
    const value = hit && (hit.value ?? this.#scale.isovalue);
    if (hit && value !== null) {
      text += `\n${this.#scale.field} = ${readable(value)}`;
      if (this.#scale.bound !== null) text += ` ± ${readable(this.#scale.bound)}`;
    }
    byId('cursor').textContent = text;
  }

  #savePicture() {
    const caption = `${this.#title}, ${readableCount(this.#frame?.triangles ?? 0)} triangles`;
    pictureWithLegend(this.#stage, caption)
      .toBlob((blob) => download(blob, 'nestgrid.png'), 'image/png');
  }

  async #saveModel() {
    try {
      download(new Blob([await this.#stage.gltf()], { type: 'model/gltf-binary' }), 'nestgrid.glb');
    } catch (error) {
      showMessage(`the model could not be saved: ${error.message}`);
    }
  }
}
