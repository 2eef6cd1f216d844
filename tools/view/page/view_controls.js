// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Keys on the picture and buttons beside it: what a hand on the mouse does, without one.
import { tell } from './status.js';

const byId = (id) => document.getElementById(id);
const turnStep = Math.PI / 36;
const zoomStep = 1.15;
const moveStep = 40;
const aimStep = 8;
const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

// From above and below, y is up in the picture.
const sides = {
  x: [1, 0, 0], '-x': [-1, 0, 0], y: [0, 1, 0], '-y': [0, -1, 0], z: [0, -1e-6, 1], '-z': [0, -1e-6, -1],
};

export class ViewControls {
  #stage;
  #canvas = byId('canvas');
  #aim = byId('aim');
  #does;
  /** The aim, as parts of the width and height of the picture. */
  #at = [0.5, 0.5];
  #waiting = null;

  /**
   * does: { moved, the view is another one; reset, the reader wants the first view; project, takes a
   *   projection; aimed, pressed, take a place of the window; sized, takes a factor for the lens }
   */
  constructor(stage, does) {
    this.#stage = stage;
    this.#does = does;
    this.#canvas.addEventListener('keydown', (event) => {
      if (this.#key(event)) event.preventDefault();
    });
    this.#canvas.addEventListener('focus', () => {
      if (this.#canvas.matches(':focus-visible')) this.#showAim();
    });
    this.#canvas.addEventListener('blur', () => { this.#aim.toggleAttribute('hidden', true); });
    this.#canvas.addEventListener('pointermove', () => { this.#aim.toggleAttribute('hidden', true); });
    byId('view-section').addEventListener('click', ({ target }) => this.#button(target));
    byId('reset').addEventListener('click', () => this.#reset());
    byId('projection').addEventListener('change', ({ target }) => {
      this.project(target.value);
      does.project(target.value);
    });
  }

  /** Shows the picture in a projection. */
  project(projection) {
    byId('projection').value = projection;
    this.#stage.view.projection = projection;
    this.#stage.draw();
  }

  /** Returns whether the key means something here. */
  #key(event) {
    const arrow = arrows[event.key];
    if (arrow) return this.#arrow(arrow, event);
    if (event.ctrlKey || event.metaKey || event.altKey) return this.#lens(event);
    const side = `${event.shiftKey ? '-' : ''}${event.key.toLowerCase()}`;
    if (sides[side]) this.#lookFrom(side);
    else if (event.key === '+' || event.key === '=') this.#zoom(zoomStep);
    else if (event.key === '-') this.#zoom(1 / zoomStep);
    else if (event.key === 'Home' || event.key === '0') this.#reset();
    else if (event.key === 'Enter' || event.key === ' ') this.#does.pressed(...this.#showAim());
    else return this.#lens(event);
    return true;
  }

  #arrow([right, up], event) {
    const { view } = this.#stage;
    if (event.ctrlKey || event.altKey || event.metaKey) {
      const { clientWidth, clientHeight } = this.#canvas;
      const inside = (x) => Math.min(Math.max(x, 0), 1);
      this.#at = [
        inside(this.#at[0] + (aimStep * right) / clientWidth),
        inside(this.#at[1] - (aimStep * up) / clientHeight)];
      this.#does.aimed(...this.#showAim());
      return true;
    }
    if (event.shiftKey) view.move(moveStep * right, -moveStep * up);
    else view.turn(turnStep * right, turnStep * up);
    this.#moved();
    return true;
  }

  /** Brackets need other keys held on some keyboards. */
  #lens({ key }) {
    if (key !== '[' && key !== ']') return false;
    this.#does.sized(key === ']' ? zoomStep : 1 / zoomStep);
    return true;
  }

  #button({ dataset }) {
    if (dataset.from) this.#lookFrom(dataset.from);
    if (dataset.zoom) this.#zoom(dataset.zoom === 'in' ? zoomStep : 1 / zoomStep);
    if (!dataset.turn) return;
    const [right, up] = dataset.turn.split(',').map(Number);
    this.#stage.view.turn(3 * turnStep * right, 3 * turnStep * up);
    this.#moved();
  }

  #lookFrom(side) {
    this.#stage.view.lookFrom(sides[side]);
    tell('camera', `The picture from the side of ${side.replace('-', 'minus ')}`);
    this.#moved();
  }

  #zoom(factor) {
    this.#stage.view.zoom(factor);
    this.#moved();
  }

  #reset() {
    this.#stage.look(null);
    tell('camera', 'The picture shows all');
    this.#does.reset();
  }

  #moved() {
    this.#stage.draw();
    clearTimeout(this.#waiting);
    this.#waiting = setTimeout(() => this.#does.moved(), 200);
  }

  /** Shows the aim. Returns its place in the window. */
  #showAim() {
    const { left, top, width, height } = this.#canvas.getBoundingClientRect();
    const at = [this.#at[0] * width, this.#at[1] * height];
    this.#aim.toggleAttribute('hidden', false);
    this.#aim.style.left = `${at[0]}px`;
    this.#aim.style.top = `${at[1]}px`;
    return [left + at[0], top + at[1]];
  }
}
