// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which volume of a file is in the picture, where it has several frames, numbers per sample or arrays,
// and what is left out.
const byId = (id) => document.getElementById(id);
const ids = ['array', 'component', 'frame'];

const options = (texts) => texts.map(([value, text]) => new Option(text, value));
const inSentenceCase = (text) => text.slice(0, 1).toUpperCase() + text.slice(1);

export class VolumeControls {
  #info = null;

  /** choose(choice, what): the reader wants another volume; what is 'array', 'component' or 'frame' */
  constructor(choose) {
    for (const id of ids) {
      byId(id).addEventListener('change', () => choose(this.#choice(), id));
    }
    byId('frame').addEventListener('input', () => this.#showFrame());
  }

  /** Shows what the info of an engine offers and tells. */
  show(info) {
    this.#info = info;
    const { offers, choice, note } = info;
    byId('array').replaceChildren(...options(offers.arrays.map((name) => [name, name])));
    byId('array').value = choice.array;
    const numbers = [...Array(offers.components).keys()].map((i) => [String(i), String(i)]);
    byId('component').replaceChildren(...options([...numbers, ['magnitude', 'magnitude']]));
    byId('component').value = String(choice.component);
    byId('frame').max = String(offers.frames - 1);
    byId('frame-last').textContent = byId('frame').max;
    byId('frame').value = String(choice.frame);
    this.#showFrame();
    byId('array-line').hidden = offers.arrays.length < 2;
    byId('component-line').hidden = offers.components < 2;
    byId('frame-controls').hidden = offers.frames < 2;
    byId('volume-note').textContent = note === '' ? '' : `${inSentenceCase(note)}.`;
    byId('volume-section').hidden = note === '' && ids.every((id) => byId(id).parentElement.hidden);
  }

  #showFrame() {
    const text = `frame ${byId('frame').value}`;
    byId('frame').setAttribute('aria-valuetext', text);
    byId('frame-text').textContent = text;
  }

  #choice() {
    const { offers } = this.#info;
    const component = byId('component').value;
    return {
      ...(offers.arrays.length > 1 && { array: byId('array').value }),
      ...(offers.components > 1 && {
        component: component === 'magnitude' ? component : Number(component),
      }),
      ...(offers.frames > 1 && { frame: Number(byId('frame').value) }),
    };
  }
}
