// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames as bytes (frame_reply.hpp), and the order in which they are asked for.

const arrayTypes = { int8: Int8Array, uint32: Uint32Array, float32: Float32Array };

/** The text of a frame, as an object whose arrays lie in the buffer. */
export function decodeFrame(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const frame = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  for (const part of frame.parts) {
    for (const name of ['positions', 'indices', 'normals', 'values']) {
      const array = part[name];
      if (array) part[name] = new arrayTypes[array.type](buffer, 4 + length + array.at, array.count);
    }
  }
  frame.bytes = buffer.byteLength;
  return frame;
}

/**
 * Asks for one frame at a time; of what is wanted meanwhile only the newest counts.
 * request: makes the text of a request from whether the picture is still moving
 * show: takes a frame, fail: takes an Error
 */
export class FrameLoop {
  #engine;
  #request;
  #show;
  #fail;
  #busy = false;
  #wanted = null;

  constructor(engine, { request, show, fail }) {
    this.#engine = engine;
    this.#request = request;
    this.#show = show;
    this.#fail = fail;
  }

  /** motion: 'moving' or 'settled' */
  want(motion) {
    this.#wanted = motion;
    if (!this.#busy) this.#run();
  }

  get idle() {
    return !this.#busy;
  }

  async #run() {
    this.#busy = true;
    while (this.#wanted) {
      const motion = this.#wanted;
      this.#wanted = null;
      const request = this.#request(motion);
      if (!request) continue;
      try {
        const start = performance.now();
        const frame = decodeFrame(await this.#engine.frame(request));
        this.#show(frame, { motion, request, milliseconds: performance.now() - start });
      } catch (error) {
        this.#fail(error);
      }
    }
    this.#busy = false;
  }
}
