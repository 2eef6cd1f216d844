// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads files and draws frames beside the page. Answers each message {id, call, ...} with
// {id, result} or {id, failure, hasVolume}, one after the other, and tells meanwhile what it does: {told}.
import { describingFile, openVolume } from './readers/open_volume.js';
import { VolumeModule } from './volume_module.js';

const compiled = fetch(new URL('nestgrid.wasm', import.meta.url))
  .then((response) => response.arrayBuffer())
  .then((bytes) => WebAssembly.compile(bytes));

/** The module with the volume in the picture; another one takes its place when it is ready. */
let module = null;

const pauseOfTelling = 100;
let lastTold = 0;

function tell(told) {
  const now = performance.now();
  if (now - lastTold < pauseOfTelling) return;
  lastTold = now;
  postMessage({ told });
}

const calls = {
  /** choice: as openVolume() takes it */
  async open({ files, choice }) {
    const { file } = describingFile(files);
    const volume = await openVolume(files, { ...choice, firstOfSeveral: true });
    const next = await VolumeModule.make(await compiled, tell);
    const info = await next.open(volume);
    module = next;
    const stem = file.name.replace(/(\.nii)?\.[^.]*$/i, '');
    return {
      ...info,
      title: file.name,
      name: volume.name || stem,
      length_unit: volume.lengthUnit,
      space: volume.space,
      note: volume.note,
      offers: volume.offers,
      choice: volume.choice,
    };
  },
  async pulse() {
    return { doing: '', share: null };
  },
  async frame({ request }) {
    if (!module) throw new Error('there is no volume yet');
    return module.frame(request);
  },
};

/** A sentence for the reader. A core that has stopped is not asked again. */
function sentenceOf(error) {
  if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) {
    module = null;
    return 'the core has stopped, probably because memory does not suffice: open a smaller volume';
  }
  return error.message;
}

async function answer({ id, call, ...values }) {
  try {
    const result = await calls[call](values);
    postMessage({ id, result }, result instanceof ArrayBuffer ? [result] : []);
  } catch (error) {
    postMessage({ id, failure: sentenceOf(error), hasVolume: module !== null });
  }
}

let last = Promise.resolve();
addEventListener('message', ({ data }) => {
  last = last.then(() => answer(data));
});
