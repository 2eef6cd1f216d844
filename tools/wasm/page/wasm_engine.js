// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Opens files and draws their surfaces in a worker of this page. No file leaves the machine.
import { describingFile, formats } from './readers/open_volume.js';

const nothing = { doing: '', share: null };

function aborted() {
  return new DOMException('nobody waits for this any more', 'AbortError');
}

export class WasmEngine {
  takesFiles = true;
  // What is aborted ends with its worker, and the next one reads the file again.
  stopsCheaply = false;
  formats = `Volumes: ${formats.join(', ')}; headers together with their data files`;

  #worker = null;
  #waiting = new Map();
  #calls = 0;
  #told = nothing;
  /** The files and the choice whose volume the worker has, or had. */
  #opened = null;
  #hasVolume = false;

  constructor() {
    this.#start();
  }

  async open(files, choice, signal) {
    const { file, format } = describingFile(files);
    const rawFormat = format === '.raw' ? await this.#rawFormatOf(file, signal) : null;
    const whole = { ...choice, rawFormat };
    const info = await this.#call({ call: 'open', files, choice: whole }, signal);
    this.#opened = { files, choice: whole };
    this.#hasVolume = true;
    return info;
  }

  /** Asks, unless the file is the one that was asked about last, or its name tells. */
  async #rawFormatOf(file, signal) {
    const {
      files: [last],
      choice,
    } = this.#opened ?? { files: [] };
    if (last === file) return choice.rawFormat;
    const { rawFormatOfName } = await import('./readers/raw.js');
    const { askRawFormat } = await import('./raw_dialog.js');
    return rawFormatOfName(file.name) ?? askRawFormat(file, signal);
  }

  async frame(request, signal) {
    if (this.#opened && !this.#hasVolume) {
      await this.#call({ call: 'open', ...this.#opened }, signal);
      this.#hasVolume = true;
    }
    return this.#call({ call: 'frame', request }, signal);
  }

  /** A worker that draws cannot be asked: it tells by itself. */
  async pulse(signal) {
    if (this.#waiting.size > 0) return this.#told;
    return this.#call({ call: 'pulse' }, signal, () => {});
  }

  /** abort: what an abort does */
  #call(message, signal, abort = () => this.#restart(aborted())) {
    return new Promise((resolve, reject) => {
      const id = this.#calls++;
      const end = () => {
        abort();
        reject(aborted());
        this.#waiting.delete(id);
      };
      const settle = (act) => (value) => {
        signal?.removeEventListener('abort', end);
        act(value);
      };
      if (signal?.aborted) {
        reject(aborted());
        return;
      }
      signal?.addEventListener('abort', end, { once: true });
      this.#waiting.set(id, { resolve: settle(resolve), reject: settle(reject) });
      this.#worker.postMessage({ id, ...message });
    });
  }

  #start() {
    const worker = new Worker(new URL('volume_worker.js', import.meta.url), { type: 'module' });
    worker.addEventListener('message', ({ data }) => this.#take(data));
    worker.addEventListener('error', () => {
      const failed = new Error(
        'The part of this page that reads files has failed; it begins anew.',
      );
      if (worker === this.#worker) this.#restart(failed);
    });
    this.#worker = worker;
    this.#told = nothing;
  }

  #take({ id, result, failure, hasVolume, told }) {
    if (told) {
      this.#told = told;
      return;
    }
    const waiting = this.#waiting.get(id);
    this.#waiting.delete(id);
    this.#told = nothing;
    if (failure === undefined) waiting?.resolve(result);
    else {
      this.#hasVolume = hasVolume;
      waiting?.reject(new Error(failure));
    }
  }

  /** Ends what the worker does. The next frame opens the file again. */
  #restart(error) {
    this.#worker.terminate();
    this.#hasVolume = false;
    const waiting = [...this.#waiting.values()];
    this.#waiting.clear();
    this.#start();
    for (const { reject } of waiting) reject(error);
  }
}
