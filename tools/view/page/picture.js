// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The picture with its legend, the value at the cursor, and what can be saved: the same wherever
// surfaces come from.
import { readable } from './colours.js';
import { showLegend } from './legend.js';
import { SavedPicture, download } from './saved_picture.js';
import { Stage } from './stage.js';
import { setWhy, showMessage, tell } from './status.js';
import { ViewControls } from './view_controls.js';

const byId = (id) => document.getElementById(id);

export class Picture {
  #stage;
  #view;
  #saved;
  #frame = null;
  #scale = null;

  /**
   * does: {
   *   moved     the reader has turned or moved the picture
   *   reset     the reader has asked for the view of the beginning
   *   project   takes the projection that the reader has chosen
   *   hovered, clicked   take what lies there (Stage.pick), or null
   *   sized     takes a factor for the lens
   *   address   returns the address of the whole view, for who saves it
   * }
   */
  constructor(does) {
    const nothing = () => {};
    const { hovered, clicked, sized } = { hovered: nothing, clicked: nothing, sized: nothing, ...does };
    this.#stage = new Stage(byId('canvas'), does.moved);
    this.#followCursor(hovered, clicked);
    this.#view = new ViewControls(this.#stage, {
      moved: does.moved,
      reset: does.reset,
      project: does.project,
      sized,
      aimed: (x, y) => hovered(this.#aimAt(x, y)),
      pressed: (x, y) => clicked(this.#aimAt(x, y)),
    });
    this.#saved = new SavedPicture(this.#stage, does.address);
    byId('screenshot').addEventListener('click', () => this.#saved.ask());
    byId('gltf').addEventListener('click', () => this.#saveModel());
  }

  get stage() {
    return this.#stage;
  }

  setTitle(title) {
    this.#saved.title = title;
    document.title = `${title} – nestgrid`;
    byId('title').textContent = title;
  }

  /** Shows the picture in perspective or parallel projection. */
  project(projection) {
    this.#view.project(projection);
  }

  /**
   * Shows a frame.
   * scale: { field, its name; unit, lengthUnit, '' where they are not known; least, greatest, the ends
   *   of the colours, null where nothing has one; isovalues, of its isosurfaces; bound, of the error,
   *   null where it says nothing; plane, { point, normal } of the slice, or null }
   */
  show(frame, scale) {
    const { field, unit, least, greatest, isovalues } = scale;
    const legend = frame.parts.some((part) => part.values) || isovalues.length > 1
      ? { field, unit, least, greatest, marks: isovalues } : null;
    showLegend(legend);
    this.#stage.setPlane(scale.plane);
    this.#stage.show(frame, least, greatest);
    this.#frame = frame;
    this.#scale = scale;
    this.#saved.content = { legend, lengthUnit: scale.lengthUnit, frame };
    setWhy('save-section', frame.triangles === 0 ? 'There is no surface to save.' : '');
  }

  /** Shows nothing. */
  clear() {
    this.#frame = null;
    this.#scale = null;
    showLegend(null);
    byId('cursor').textContent = '';
    this.#stage.setPlane(null);
    this.#stage.show({ parts: [] }, null, null);
    setWhy('save-section', 'There is no surface to save.');
  }

  #followCursor(hovered, clicked) {
    const canvas = byId('canvas');
    let last = null;
    const look = () => {
      const event = last;
      last = null;
      if (!event || event.buttons !== 0 || !this.#frame) return;
      hovered(this.#lookAt(event.clientX, event.clientY));
    };
    canvas.addEventListener('pointermove', (event) => {
      if (!last) requestAnimationFrame(look);
      last = event;
    });
    canvas.addEventListener('pointerleave', () => this.#tell(null));
    // What follows a drag is no click.
    let from = null;
    canvas.addEventListener('pointerdown', (event) => { from = [event.clientX, event.clientY]; });
    canvas.addEventListener('click', (event) => {
      const way = from ? Math.hypot(event.clientX - from[0], event.clientY - from[1]) : 0;
      if (this.#frame && way < 5) clicked(this.#stage.pick(event.clientX, event.clientY));
    });
  }

  #aimAt(x, y) {
    const hit = this.#lookAt(x, y);
    tell('aim', byId('cursor').textContent.replace('\n', ', ') || 'Nothing is at the aim');
    return hit;
  }

  #lookAt(x, y) {
    const hit = this.#frame && this.#stage.pick(x, y);
    this.#tell(hit);
    return hit;
  }

  #tell(hit) {
    const unit = this.#scale?.lengthUnit ? ` ${this.#scale.lengthUnit}` : '';
    const place = hit
      ? ['x', 'y', 'z'].map((axis, d) => `${axis} ${readable(hit.point[d])}${unit}`) : [];
    let text = place.join('   ');
    const { isovalues } = this.#scale ?? {};
    const value = hit && (hit.value ?? (isovalues.length === 1 ? isovalues[0] : null));
    if (hit && value !== null) {
      const range = this.#scale.greatest - this.#scale.least;
      text += `\n${this.#scale.field} = ${readable(value, range)}`;
      if (this.#scale.unit) text += ` ${this.#scale.unit}`;
      if (this.#scale.bound !== null) text += ` ± ${readable(this.#scale.bound, range)}`;
    }
    byId('cursor').textContent = text;
  }

  async #saveModel() {
    try {
      download(new Blob([await this.#stage.gltf()], { type: 'model/gltf-binary' }), 'nestgrid.glb');
    } catch (error) {
      showMessage(`the model could not be saved: ${error.message}`);
    }
  }
}
