// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Asks an engine again and again whether it is there, and tells the reader when it is not.
import { showConnection } from './status.js';

/** Milliseconds between questions, while nothing is drawn and while something is. */
const calm = 700;
const busy = 250;
/** An engine that says nothing for so long hangs. */
const longest = 1500;

function button(text, act) {
  const made = document.createElement('button');
  made.type = 'button';
  made.textContent = text;
  made.addEventListener('click', act);
  return made;
}

/** Takes the address that a program has printed, and goes there with the view of this page. */
function addressForm() {
  const row = document.createElement('p');
  row.className = 'line';
  const input = document.createElement('input');
  input.type = 'text';
  input.id = 'new-address';
  input.placeholder = 'http://127.0.0.1:…';
  input.setAttribute('aria-label', 'The address that the program prints');
  const go = () => {
    const address = URL.canParse(input.value.trim()) ? new URL(input.value.trim()) : null;
    const fits = address !== null && /^https?:$/.test(address.protocol);
    input.setAttribute('aria-invalid', String(!fits));
    if (fits) location.href = `${address.origin}${address.pathname}${location.hash}`;
  };
  input.addEventListener('keydown', (event) => { if (event.key === 'Enter') go(); });
  row.append(input, button('Open this view there', go));
  return row;
}

const sentences = {
  hanging: 'The program behind this page does not answer: it is stopped, or very busy. '
    + 'The page goes on as soon as it answers.',
  lost: 'The program behind this page has ended. Start it again, and paste the address that it prints: '
    + 'the view stays as it is.',
};

export class Heartbeat {
  #engine;
  #tell;
  #resume;
  #isBusy;
  #state = 'alive';
  #timer = null;
  #running = false;

  /**
   * isBusy: whether a frame is being drawn
   * tell: takes what the engine says of its work
   * resume: called when an engine that was gone is there again
   */
  constructor(engine, { isBusy, tell, resume }) {
    this.#engine = engine;
    this.#isBusy = isBusy;
    this.#tell = tell;
    this.#resume = resume;
  }

  /** 'alive', 'hanging' or 'lost' */
  get state() {
    return this.#state;
  }

  start() {
    this.#running = true;
    this.check();
  }
  stop() {
    this.#running = false;
    clearTimeout(this.#timer);
    this.#set('alive');
  }

  /** Asks at once. */
  async check() {
    clearTimeout(this.#timer);
    const asking = new AbortController();
    const limit = setTimeout(() => asking.abort(), longest);
    let state = 'alive';
    try {
      this.#tell(await this.#engine.pulse(asking.signal));
    } catch (error) {
      state = error.isLost ? 'lost' : 'hanging';
    }
    clearTimeout(limit);
    if (!this.#running) return;
    this.#set(state);
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.check(), this.#isBusy() ? busy : calm);
  }

  #set(state) {
    if (state === this.#state) return;
    const before = this.#state;
    this.#state = state;
    document.body.dataset.program = state;
    if (state === 'alive') {
      showConnection('');
      if (before !== 'alive' && this.#running) this.#resume();
      return;
    }
    const again = button('Ask again', () => this.check());
    showConnection(sentences[state], state === 'lost' ? [addressForm(), again] : [again]);
  }
}
