// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page of a solver: each frame is the newest surface that the solver has pushed. The camera stays
// where the reader has put it.
import { readable, readableCount } from './colours.js';
import { decodeFrame } from './frame.js';
import { Picture } from './picture.js';
import { addressOf, stateFromAddress } from './state.js';
import { setWhy, showMessage, showNumbers, tell } from './status.js';

const byId = (id) => document.getElementById(id);
const pause = (milliseconds) => new Promise((resolve) => { setTimeout(resolve, milliseconds); });

const start = { outlines: false, camera: null, projection: 'perspective' };
const sentences = {
  waiting: 'The solver has shown no surface yet',
  running: 'The solver is running',
  ended: 'The solver has ended',
  lost: 'The solver has ended or cannot be reached',
};

export class PushedPage {
  #engine;
  #picture;
  #state = stateFromAddress(location.hash, start);
  #number = 0;
  #box = null;
  #shown = null;
  #asking = new AbortController();

  /** Called when the solver has ended, and when it cannot be reached. */
  ended = () => {};
  lost = () => {};

  constructor(engine) {
    this.#engine = engine;
    this.#picture = new Picture({
      moved: () => this.#remember(),
      reset: () => this.#remember(null),
      project: (projection) => {
        this.#state.projection = projection;
        this.#remember();
      },
      address: () => addressOf({ ...this.#state, camera: this.stage.camera }),
    });
    this.#picture.project(this.#state.projection);
    document.body.classList.add('pushed');
    byId('outlines-section').hidden = true;
    byId('outlines').checked = this.#state.outlines;
    byId('outlines').addEventListener('change', (event) => {
      this.#state.outlines = event.target.checked;
      this.#remember();
      this.#number = 0;  // the same surface, as it is wanted now
      this.#asking.abort();
    });
  }

  begin(info) {
    this.#picture.setTitle(info.title);
    this.#tell('waiting');
    this.#follow();
  }

  /** The surface in the picture. */
  get shown() {
    return this.#shown;
  }
  /** A surface that is awaited is no work. */
  get idle() {
    return true;
  }
  /** #follow() asks again by itself. */
  resume() {}
  get stage() {
    return this.#picture.stage;
  }

  #tell(connection) {
    if (document.body.dataset.connection === connection) return;
    byId('subtitle').textContent = sentences[connection];
    document.body.dataset.connection = connection;
    tell('connection', sentences[connection]);
    setWhy('outlines-section',
      connection === 'running' ? '' : 'Outlines come from the solver while it runs.');
  }

  #remember(camera = this.stage.camera) {
    if (!this.#box) return;
    this.#state.camera = camera;
    history.replaceState(null, '', addressOf(this.#state, start));
  }

  /** Takes the newest surface, again and again, until the solver ends. */
  async #follow() {
    for (let running = true; running;) {
      try {
        running = await this.#ask();
      } catch (error) {
        if (error.name === 'AbortError') continue;
        if (!error.isLost) {
          showMessage(error.message);
          return;
        }
        this.#tell('lost');
        this.lost();
        await pause(2000);
      }
    }
  }

  /** Waits for the next surface. Returns whether the solver may push more. */
  async #ask() {
    this.#asking = new AbortController();
    const { outlines } = this.#state;
    const begin = performance.now();
    const request = `after=${this.#number}&outlines=${outlines ? 'on' : 'off'}`;
    const frame = decodeFrame(await this.#engine.frame(request, this.#asking.signal));
    if (this.#asking.signal.aborted) return true;
    if (frame.parts.length > 0) {
      this.#number = frame.number;
      this.#show(frame);
    }
    if (frame.ended) {
      this.#tell('ended');
      this.ended();
    } else {
      this.#tell(this.#number > 0 ? 'running' : 'waiting');
    }
    // So many readers wait that the server lets this one ask again.
    if (frame.parts.length === 0 && performance.now() - begin < 500) await pause(500);
    return !frame.ended;
  }

  #show(frame) {
    showMessage(frame.triangles === 0 ? 'The surface is empty.' : '');
    this.#setBox(frame.box);
    const { field, least, greatest } = frame;
    // Colours of a surface are those of another quantity than the one whose value it has.
    const coloured = frame.parts.some((part) => part.values);
    const isovalues = coloured || frame.isovalue === null ? [] : [frame.isovalue];
    this.#picture.show(frame, {
      field, unit: '', lengthUnit: '', least, greatest, isovalues, bound: null, plane: null });
    byId('outlines-section').hidden = !frame.outlined;
    const number = (x) => (Number.isInteger(x) ? readableCount(x) : readable(x));
    showNumbers([
      ...(frame.time === null ? [] : [['time', 'time', readable(frame.time)]]),
      ...(frame.step === null ? [] : [['step', 'step', readableCount(frame.step)]]),
      ...frame.numbers.map(({ name, value }, i) => [`solver-${i}`, name, number(value)]),
      ['triangles', 'triangles', readableCount(frame.triangles)],
      ['surfaces', 'surfaces so far', readableCount(frame.number), 'How many the solver has pushed'],
    ]);
    this.#shown = { frame };
  }

  /** Looks at the first box; later ones may grow while the camera stays. */
  #setBox(box) {
    if (box[0][0] === null || JSON.stringify(box) === JSON.stringify(this.#box)) return;
    const isFirst = !this.#box;
    this.#box = box;
    this.stage.setBox(box);
    if (isFirst) this.stage.look(this.#state.camera);
  }
}
