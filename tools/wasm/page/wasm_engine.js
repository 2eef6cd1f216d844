// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Opens files and draws their surfaces in a worker of this page. No file leaves the machine.
import { askRawFormat } from './raw_dialog.js';
import { formats } from './readers/open_volume.js';
import { rawFormatOfName } from './readers/raw.js';

export class WasmEngine {
  takesFiles = true;
  formats = `Volumes: ${formats.join(', ')}`;

  #worker = new Worker(new URL('volume_worker.js', import.meta.url), { type: 'module' });
  #waiting = new Map();
  #calls = 0;

  constructor() {
    this.#worker.addEventListener('message', ({ data: { id, result, failure } }) => {
      const { resolve, reject } = this.#waiting.get(id);
      this.#waiting.delete(id);
      if (failure === undefined) resolve(result);
      else reject(new Error(failure));
    });
    this.#worker.addEventListener('error', () => {
      for (const { reject } of this.#waiting.values()) {
        reject(new Error('the part of the page that reads files has failed: load the page again'));
      }
      this.#waiting.clear();
    });
  }

  async open(file) {
    const isRaw = file.name.toLowerCase().endsWith('.raw');
    const rawFormat = isRaw ? (rawFormatOfName(file.name) ?? (await askRawFormat(file))) : null;
    return this.#call({ call: 'open', file, rawFormat });
  }

  frame(request) {
    return this.#call({ call: 'frame', request });
  }

  #call(message) {
    return new Promise((resolve, reject) => {
      const id = this.#calls++;
      this.#waiting.set(id, { resolve, reject });
      this.#worker.postMessage({ id, ...message });
    });
  }
}
