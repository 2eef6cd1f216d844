// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page of a field: each frame is what the controls ask for.
import { Controls } from './controls.js';
import { readable, readableCount } from './colours.js';
import { FrameLoop } from './frame.js';
import { drawHistogram } from './legend.js';
import { Picture } from './picture.js';
import { addressOf, defaultState, planeOf, requestOf, stateFromAddress } from './state.js';
import { showMessage, showNumbers, tell } from './status.js';

const byId = (id) => document.getElementById(id);

export class ExploredPage {
  #info;
  #state;
  #picture;
  #controls;
  #loop;
  #shown = null;
  #rest = null;

  constructor(engine) {
    this.#picture = new Picture({
      moved: () => this.#remember(),
      reset: () => this.#change({ camera: null }, 'settled'),
      project: (projection) => {
        this.#state.projection = projection;
        this.#remember();
      },
      address: () => addressOf({ ...this.#state, camera: this.stage.camera }),
      hovered: (hit) => this.#hover(hit),
      clicked: (hit) => {
        if (hit && this.#state.lens === 'click') this.#change({ centre: hit.point }, 'settled');
      },
      sized: (factor) => {
        if (this.#state.lens !== 'off') this.#change({ radius: factor * this.#state.radius }, 'settled');
      },
    });
    this.#controls = new Controls((changes, motion) => this.#change(changes, motion));
    this.#loop = new FrameLoop(engine, {
      request: (motion) => requestOf(this.#state, this.#info, motion),
      show: (frame, how) => this.#show(frame, how),
      fail: (error) => showMessage(error.message),
    });
    addEventListener('hashchange', () => {
      if (this.#info && location.hash !== addressOf(this.#state, this.#start)) this.#restore();
    });
  }

  begin(info) {
    showMessage('');
    this.#info = info;
    this.#picture.setTitle(info.title);
    byId('subtitle').textContent =
      `${readableCount(info.nodes)} nodes, values from ${readable(info.least)} to ${readable(info.greatest)}`;
    document.querySelectorAll('.field-name').forEach((e) => { e.textContent = `“${info.name}”`; });
    drawHistogram(info);
    this.stage.setBox(info.box);
    this.#restore();
  }

  /** The frame in the picture, with what was asked for. */
  get shown() {
    return this.#shown;
  }
  get idle() {
    return this.#loop.idle;
  }
  get stage() {
    return this.#picture.stage;
  }

  get #start() {
    return defaultState(this.#info);
  }

  #restore() {
    this.#state = stateFromAddress(location.hash, this.#start);
    this.#picture.project(this.#state.projection);
    this.stage.look(this.#state.camera);
    this.#showControls();
    this.#loop.want('settled');
  }

  #showControls() {
    this.#controls.show(this.#state, this.#info);
    const { lens, centre, radius } = this.#state;
    this.stage.setLens(lens !== 'off' && centre ? { centre, radius } : null);
  }

  #change(changes, motion) {
    if (changes.slice === 'view') changes.normal = this.stage.towardsReader;
    Object.assign(this.#state, changes);
    this.#showControls();
    this.#loop.want(motion);
    if (motion === 'settled') this.#remember();
  }

  #remember() {
    if (!this.#state) return;
    this.#state.camera = this.stage.camera;
    history.replaceState(null, '', addressOf(this.#state, this.#start));
  }

  #show(frame, how) {
    showMessage('');
    const { name, least, greatest, unit = '', length_unit: lengthUnit = '' } = this.#info;
    const bound = frame.error_bound;
    this.#picture.show(frame, {
      field: name, unit, lengthUnit, least, greatest, bound,
      isovalue: this.#state.surface ? this.#state.isovalue : null,
      plane: planeOf(this.#state, this.#info),
    });
    if (how.motion === 'settled') {
      tell(`${readableCount(frame.triangles)} triangles, error at most ${readable(bound)}`);
    }
    showNumbers([
      ['triangles', 'triangles', readableCount(frame.triangles)],
      ['bound', 'error at most', readable(bound),
        'On the surface, the data differ from its value by no more'],
      ['threshold', 'threshold', readable(frame.threshold), 'Detail up to this is left out'],
      ['visited', 'visited', `${readableCount(frame.visited)} elements`,
        'Elements that the search entered'],
      ['ms', 'extraction', `${readable(1000 * frame.seconds)} ms`, 'Time to extract the surface'],
    ]);
    if (frame.triangles === 0) showMessage('There is nothing here: no data have this value.');
    this.#shown = { frame, ...how };
  }

  #hover(hit) {
    if (!hit || this.#state.lens !== 'cursor') return;
    this.#change({ centre: hit.point }, 'moving');
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => this.#change({}, 'settled'), 250);
  }
}
