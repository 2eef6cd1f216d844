// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The core as WebAssembly, with one volume. Runs in a worker and in Node alike; who makes a module
// compiles nestgrid.wasm.

/**
 * What the core asks of its surroundings: the time. It knows no files and no environment.
 * tell: tell(at, share) is told what a frame is doing, a text in memory
 */
function surroundings(memory, tell) {
  const unknown = 52;
  const wasi = {
    clock_time_get(clock, precision, at) {
      const nanoseconds = BigInt(Math.round(performance.now() * 1e6));
      new DataView(memory().buffer).setBigUint64(at >>> 0, nanoseconds, true);
      return 0;
    },
    proc_exit(code) {
      throw new WebAssembly.RuntimeError(`the core ended with code ${code}`);
    },
  };
  const other = { get: (functions, name) => functions[name] ?? (() => unknown) };
  return {
    wasi_snapshot_preview1: new Proxy(wasi, other),
    env: { emscripten_notify_memory_growth() {}, tell },
  };
}

export class VolumeModule {
  #core;

  /**
   * compiled: a WebAssembly.Module. A module and its memory go when nobody holds it.
   * tell: takes what a frame is doing while it is drawn, { doing, share }; the share is null where it
   *   is not known
   */
  static async make(compiled, tell = () => {}) {
    const module = new VolumeModule();
    const instance = await WebAssembly.instantiate(
      compiled,
      surroundings(
        () => module.#core.memory,
        (at, share) =>
          tell({ doing: module.#text(at >>> 0), share: Number.isNaN(share) ? null : share }),
      ),
    );
    module.#core = instance.exports;
    module.#core._initialize();
    return module;
  }

  /**
   * Reads a volume (readers/volume.js) into the memory of the core, and prepares its frames.
   * returns what Explorer::info() tells
   */
  async open(volume) {
    const at = this.#core.allocate(volume.bytes) >>> 0;
    if (at === 0) throw this.#failure();
    await volume.read(new Uint8Array(this.#core.memory.buffer, at, volume.bytes));
    new Float64Array(this.#core.memory.buffer, this.#core.geometry() >>> 0, 18).set([
      ...volume.samples,
      ...volume.spacing,
      ...volume.origin,
      ...volume.direction,
    ]);
    this.#write(volume.type);
    const info = this.#core.open() >>> 0;
    if (info === 0) throw this.#failure();
    return JSON.parse(this.#text(info));
  }

  /** A frame as bytes (frame_reply.hpp), in a buffer of its own. */
  frame(request) {
    this.#write(request);
    const at = this.#core.frame() >>> 0;
    if (at === 0) throw this.#failure();
    return this.#core.memory.buffer.slice(at, at + (this.#core.frame_size() >>> 0));
  }

  #write(text) {
    const bytes = new TextEncoder().encode(text);
    if (bytes.length > 2000) throw new Error('the request is longer than 2000 characters');
    const to = new Uint8Array(this.#core.memory.buffer, this.#core.text() >>> 0, bytes.length + 1);
    to.set(bytes);
    to[bytes.length] = 0;
  }

  #text(at) {
    const memory = new Uint8Array(this.#core.memory.buffer);
    return new TextDecoder().decode(memory.subarray(at, memory.indexOf(0, at)));
  }

  #failure() {
    return new Error(this.#text(this.#core.failure() >>> 0));
  }
}
