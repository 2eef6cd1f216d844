// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Joins an engine and the page of what it has.
import { Engine } from './engine.js';
import { ExploredPage } from './explored_page.js';
import { Heartbeat } from './heartbeat.js';
import { PushedPage } from './pushed_page.js';
import { addressWithoutChoice, choiceFromAddress } from './state.js';
import { showMessage } from './status.js';
import { VolumeControls } from './volume_controls.js';
import { Work } from './work.js';

const byId = (id) => document.getElementById(id);
const engine = new Engine();
const work = new Work();

/** Opens the files that a reader drops or chooses, a volume at a time. */
class Files {
  #page;
  #opening = null;
  /** Those of the volume in the picture, and its info. */
  #files = [];
  #info = null;
  #controls = new VolumeControls((choice, what) => this.open(this.#files, choice, what));

  constructor(page) {
    this.#page = page;
  }

  /**
   * Gives up what is being opened, if something is.
   * files: a file, or a header and the files with its samples
   * changed: what the reader has chosen in the files of the picture, if it is that
   */
  async open(files, choice, changed = null) {
    if (files.length === 0) return;
    this.#opening?.abort();
    const opening = new AbortController();
    this.#opening = opening;
    showMessage('');
    const job = work.begin(`Reading ${files[0].name}`, () => opening.abort());
    try {
      const info = await engine.open(files, choice, opening.signal);
      if (!opening.signal.aborted) this.#show(info, files, changed);
    } catch (error) {
      if (!opening.signal.aborted) {
        showMessage(error.message);
        // A choice of the address that does not fit the file must not stand in its way again.
        if (!byId('drop').hidden) history.replaceState(null, '', addressWithoutChoice(location.hash));
      }
    } finally {
      work.end(job);
      // What is chosen is what the picture shows.
      if (this.#opening === opening && this.#info) this.#controls.show(this.#info);
    }
  }

  #show(info, files, changed) {
    this.#files = files;
    this.#info = info;
    const drop = byId('drop');
    // The address of another file's picture says nothing about this one.
    const meant = new URLSearchParams(location.hash.slice(1)).get('file');
    if (!changed && (drop.hidden || (meant !== null && meant !== info.title))) {
      history.replaceState(null, '', location.pathname + location.search);
    }
    // What has the focus goes with the place for files.
    if (drop.contains(document.activeElement)) byId('canvas').focus();
    drop.hidden = true;
    byId('panel').inert = false;
    byId('help').hidden = false;
    byId('choose').hidden = false;
    this.#page.begin(info, changed);
  }
}

/** Lets the reader drop or choose a file, for an engine that takes files. */
function takeFiles(page) {
  const drop = byId('drop');
  const files = new Files(page);
  const open = (list) => {
    const chosen = [...list];
    // The address says how to begin.
    files.open(chosen, drop.hidden ? {} : choiceFromAddress(location.hash, chosen));
  };
  drop.hidden = false;
  byId('panel').inert = true;
  byId('help').hidden = true;
  byId('drop-formats').textContent = engine.formats ?? '';
  byId('file').addEventListener('change', (event) => {
    open(event.target.files);
    // The same file may be chosen again.
    event.target.value = '';
  });
  for (const id of ['choose', 'choose-first']) {
    byId(id).addEventListener('click', () => byId('file').click());
  }
  const hasFile = (event) => event.dataTransfer.types.includes('Files');
  document.addEventListener('dragover', (event) => {
    event.preventDefault();
    drop.classList.toggle('over', hasFile(event));
  });
  document.addEventListener('dragleave', () => drop.classList.remove('over'));
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    drop.classList.remove('over');
    open(event.dataTransfer.files);
  });
}

function follow(page) {
  const heartbeat = new Heartbeat(engine, {
    isBusy: () => !page.idle,
    tell: (told) => work.tell(told),
    resume: () => page.resume(),
  });
  page.lost = () => heartbeat.check();
  page.ended = () => heartbeat.stop();
  heartbeat.start();
}

try {
  const info = engine.takesFiles ? null : await engine.info();
  const page = info?.pushed ? new PushedPage(engine) : new ExploredPage(engine, work);
  // For tests, and for the curious.
  window.nestgrid = page;
  follow(page);
  if (info) page.begin(info);
  else takeFiles(page);
} catch (error) {
  showMessage(error.message);
}
