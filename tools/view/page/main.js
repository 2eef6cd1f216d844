// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Joins an engine, the controls and the picture.
import { Controls } from './controls.js';
import { readable, readableCount } from './colours.js';
import { Engine } from './engine.js';
import { FrameLoop } from './frame.js';
import { drawBar, drawHistogram, markLegend, pictureWithLegend } from './legend.js';
import { Stage } from './stage.js';
import { addressOf, requestOf, stateFromAddress } from './state.js';

const byId = (id) => document.getElementById(id);
const engine = new Engine();

function showMessage(text) {
  byId('message').textContent = text;
  byId('message').hidden = text === '';
}

function download(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** The page of one field. */
class Page {
  #info;
  #state;
  #stage = new Stage(byId('canvas'), () => this.#remember());
  #controls;
  #loop;
  #shown = null;

  constructor() {
    this.#controls = new Controls((changes, motion) => this.#change(changes, motion));
    this.#loop = new FrameLoop(engine, {
      request: (motion) => requestOf(this.#state, this.#info, motion),
      show: (frame, how) => this.#show(frame, how),
      fail: (error) => showMessage(error.message),
    });
    this.#followCursor();
    byId('screenshot').addEventListener('click', () => this.#savePicture());
    byId('gltf').addEventListener('click', () => this.#saveModel());
    byId('reset').addEventListener('click', () => {
      this.#stage.look(null);
      this.#stage.draw();
      this.#change({ camera: null }, 'settled');
    });
    addEventListener('hashchange', () => {
      if (this.#info && location.hash !== addressOf(this.#state, this.#info)) this.#restore();
    });
  }

  begin(info) {
    showMessage('');
    this.#info = info;
    document.title = `${info.title} – nestgrid`;
    byId('title').textContent = info.title;
    byId('subtitle').textContent =
      `${readableCount(info.nodes)} nodes, values from ${readable(info.least)} to ${readable(info.greatest)}`;
    document.querySelectorAll('.field-name').forEach((e) => { e.textContent = `“${info.name}”`; });
    drawHistogram(info);
    drawBar(info.name);
    this.#stage.setBox(info.box);
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
    return this.#stage;
  }

  #restore() {
    this.#state = stateFromAddress(location.hash, this.#info);
    this.#stage.look(this.#state.camera);
    this.#controls.show(this.#state, this.#info);
    this.#loop.want('settled');
  }

  #change(changes, motion) {
    if (changes.slice === 'view') changes.normal = this.#stage.towardsReader;
    Object.assign(this.#state, changes);
    this.#controls.show(this.#state, this.#info);
    this.#loop.want(motion);
    if (motion === 'settled') this.#remember();
  }

  #remember() {
    if (!this.#state) return;
    this.#state.camera = this.#stage.camera;
    history.replaceState(null, '', addressOf(this.#state, this.#info));
  }

  #show(frame, how) {
    showMessage('');
    const { isovalue, surface } = this.#state;
    const { least, greatest } = this.#info;
    this.#stage.show(frame, isovalue, least, greatest);
    markLegend(least, greatest, surface ? isovalue : null);
    byId('number-triangles').textContent = readableCount(frame.triangles);
    byId('number-bound').textContent = readable(frame.error_bound);
    byId('number-threshold').textContent = readable(frame.threshold);
    byId('number-visited').textContent = `${readableCount(frame.visited)} elements`;
    byId('number-ms').textContent = `${readable(1000 * frame.seconds)} ms`;
    if (frame.triangles === 0) showMessage('There is nothing here: no data have this value.');
    this.#shown = { frame, ...how };
  }

  #followCursor() {
    const canvas = byId('canvas');
    let last = null;
    let rest = null;
    const look = () => {
      const event = last;
      last = null;
      if (!event || event.buttons !== 0 || !this.#shown) return;
      const hit = this.#stage.pick(event.clientX, event.clientY);
      this.#tell(hit);
      if (!hit || this.#state.lens !== 'cursor') return;
      this.#change({ centre: hit.point }, 'moving');
      clearTimeout(rest);
      rest = setTimeout(() => this.#change({}, 'settled'), 250);
    };
    canvas.addEventListener('pointermove', (event) => {
      if (!last) requestAnimationFrame(look);
      last = event;
    });
    canvas.addEventListener('pointerleave', () => this.#tell(null));
    canvas.addEventListener('pointerdown', () => { byId('hint').hidden = true; }, { once: true });
    canvas.addEventListener('click', (event) => {
      if (!this.#shown || this.#state.lens !== 'click') return;
      const hit = this.#stage.pick(event.clientX, event.clientY);
      if (hit) this.#change({ centre: hit.point }, 'settled');
    });
  }

  #tell(hit) {
    const place = hit ? ['x', 'y', 'z'].map((axis, d) => `${axis} ${readable(hit.point[d])}`) : [];
    let value = '';
    if (hit) {
      const { error_bound: bound } = this.#shown.frame;
      value = `\n${this.#info.name} = ${readable(hit.value ?? this.#state.isovalue)}`;
      if (bound !== null) value += ` ± ${readable(bound)}`;
    }
    byId('cursor').textContent = place.join('   ') + value;
  }

  #savePicture() {
    const caption = `${this.#info.title}, ${readableCount(this.#shown?.frame.triangles ?? 0)} triangles`;
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

/** Lets the reader drop or choose a file, for an engine that takes files. */
function takeFiles(page) {
  const drop = byId('drop');
  const panel = byId('panel');
  const hint = byId('hint');
  const open = async (file) => {
    if (!file) return;
    const subtitle = byId('subtitle').textContent;
    byId('subtitle').textContent = `Reading ${file.name} …`;
    try {
      const info = await engine.open(file);
      // The address of another file's picture says nothing about this one.
      if (drop.hidden) history.replaceState(null, '', location.pathname + location.search);
      page.begin(info);
      drop.hidden = true;
      panel.inert = false;
      hint.hidden = false;
    } catch (error) {
      byId('subtitle').textContent = subtitle;
      showMessage(error.message);
    }
  };
  drop.hidden = false;
  panel.inert = true;
  hint.hidden = true;
  hint.textContent += '. Drop another file to open it';
  byId('drop-formats').textContent = engine.formats ?? '';
  byId('file').addEventListener('change', (event) => open(event.target.files[0]));
  document.addEventListener('dragover', (event) => {
    event.preventDefault();
    drop.classList.add('over');
  });
  document.addEventListener('dragleave', () => drop.classList.remove('over'));
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    drop.classList.remove('over');
    open(event.dataTransfer.files[0]);
  });
}

let page;
try {
  page = new Page();
  // For tests, and for the curious.
  window.nestgrid = page;
  if (engine.takesFiles) takeFiles(page);
  else page.begin(await engine.info());
} catch (error) {
  showMessage(error.message);
}
