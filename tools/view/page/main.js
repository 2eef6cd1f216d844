// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Joins an engine and the page of what it has.
import { Engine } from './engine.js';
import { ExploredPage } from './explored_page.js';
import { PushedPage } from './pushed_page.js';
import { showMessage } from './status.js';

const byId = (id) => document.getElementById(id);
const engine = new Engine();

/** Lets the reader drop or choose a file, for an engine that takes files. */
function takeFiles(page) {
  const drop = byId('drop');
  const panel = byId('panel');
  const open = async (file) => {
    if (!file) return;
    const subtitle = byId('subtitle').textContent;
    byId('subtitle').textContent = `Reading ${file.name} …`;
    try {
      const info = await engine.open(file);
      // The address of another file's picture says nothing about this one.
      if (drop.hidden) history.replaceState(null, '', location.pathname + location.search);
      page.begin(info);
      // What has the focus goes with the place for files.
      if (drop.contains(document.activeElement)) byId('canvas').focus();
      drop.hidden = true;
      panel.inert = false;
      byId('help').hidden = false;
      byId('choose').hidden = false;
    } catch (error) {
      byId('subtitle').textContent = subtitle;
      showMessage(error.message);
    }
  };
  drop.hidden = false;
  panel.inert = true;
  byId('help').hidden = true;
  byId('drop-formats').textContent = engine.formats ?? '';
  byId('file').addEventListener('change', (event) => open(event.target.files[0]));
  for (const id of ['choose', 'choose-first']) {
    byId(id).addEventListener('click', () => byId('file').click());
  }
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

try {
  const info = engine.takesFiles ? null : await engine.info();
  const page = info?.pushed ? new PushedPage(engine) : new ExploredPage(engine);
  // For tests, and for the curious.
  window.nestgrid = page;
  if (info) page.begin(info);
  else takeFiles(page);
} catch (error) {
  showMessage(error.message);
}
