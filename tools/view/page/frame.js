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
 * Asks for one frame at a time; of what is wanted meanwhile only the newest counts. A frame that settles
 * is given up for the next one, where the engine stops cheaply.
 */
export class FrameLoop {
  #engine;
  #work;
  #page;
  #asking = null;
  #wanted = null;

  /**
   * work: shows that a frame is being drawn (work.js)
   * page: request(motion) makes the text of a request, null where nothing is to be drawn; show(frame, how)
   *   takes the frame, or null and what was asked for; fail(error); cancelled()
   */
  constructor(engine, work, page) {
    this.#engine = engine;
    this.#work = work;
    this.#page = page;
  }

  /** motion: 'moving' or 'settled' */
  want(motion) {
    this.#wanted = motion;
    if (!this.#asking) this.#run();
    else if (this.#asking.motion === 'settled' && this.#engine.stopsCheaply) this.#asking.end.abort();
  }

  /** Gives up what is wanted and what is being drawn. */
  stop() {
    this.#wanted = null;
    this.#asking?.end.abort();
  }

  /** Takes no frame that has been asked for, and lets the engine end it where that costs nothing. */
  forget() {
    this.#wanted = null;
    if (!this.#asking) return;
    this.#asking.forgotten = true;
    if (this.#engine.stopsCheaply) this.#asking.end.abort();
  }

  get idle() {
    return !this.#asking;
  }

  async #run() {
    while (this.#wanted) {
      const motion = this.#wanted;
      this.#wanted = null;
      const asking = { motion, request: this.#page.request(motion), end: new AbortController() };
      this.#asking = asking;
      try {
        await this.#ask(asking);
      } catch (error) {
        if (!asking.end.signal.aborted && !asking.forgotten) this.#page.fail(error);
      }
    }
    this.#asking = null;
  }

  async #ask(asking) {
    const { motion, request, end } = asking;
    if (!request) {
      this.#page.show(null, { motion, request });
      return;
    }
    const job = this.#work.begin('Drawing', () => {
      this.stop();
      this.#page.cancelled();
    });
    try {
      const start = performance.now();
      const frame = decodeFrame(await this.#engine.frame(request, end.signal));
      if (end.signal.aborted || asking.forgotten) return;
      this.#page.show(frame, { motion, request, milliseconds: performance.now() - start });
    } finally {
      this.#work.end(job);
    }
  }
}
