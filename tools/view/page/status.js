// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the page tells: sentences that everybody sees, and what a screen reader says of a picture.

const byId = (id) => document.getElementById(id);
const rest = 500;
let waiting = null;
const untold = new Map();

/** Shows a sentence, or none. */
export function showMessage(text) {
  byId('message').textContent = text;
  byId('message').hidden = text === '';
}

/** Says why the stage is empty; nothing where it is not. */
export function showEmpty(text) {
  byId('empty').textContent = text;
  byId('empty').hidden = text === '';
}

/**
 * Says what has become of the program behind the page, and what the reader can do.
 * parts: elements behind the text
 */
export function showConnection(text, parts = []) {
  const sentence = document.createElement('p');
  sentence.textContent = text;
  byId('connection').replaceChildren(sentence, ...parts);
  byId('connection').hidden = text === '';
}

/**
 * Has a screen reader say a text when nothing else has come for half a second; of each topic the
 * newest text, so that a picture that ends does not silence what the reader has just asked.
 */
export function tell(topic, text) {
  untold.delete(topic);
  untold.set(topic, text);
  clearTimeout(waiting);
  waiting = setTimeout(() => {
    byId('status').textContent = [...untold.values()].join('. ');
    untold.clear();
  }, rest);
}

/** Shows the numbers of a picture. rows: [id, name, text, what it means] */
export function showNumbers(rows) {
  const term = (text) => Object.assign(document.createElement('dt'), { textContent: text });
  const told = (text) => Object.assign(document.createElement('dd'), { textContent: text });
  byId('numbers').replaceChildren(...rows.flatMap(([id, name, text]) => {
    const number = told(text);
    number.id = `number-${id}`;
    return [term(name), number];
  }));
  const meanings = rows.filter(([, , , meaning]) => meaning);
  byId('meanings').hidden = meanings.length === 0;
  byId('meanings').querySelector('dl')
    .replaceChildren(...meanings.flatMap(([, name, , meaning]) => [term(name), told(meaning)]));
}

/** Dims the controls of a section, and says why; '' makes them work again. */
export function setWhy(section, sentence) {
  const part = byId(section);
  const why = part.querySelector('.why');
  why.textContent = sentence;
  why.hidden = sentence === '';
  for (const control of part.querySelectorAll('input, select, button')) control.disabled = sentence !== '';
}

/** Dims one control with a label, and says why in it; '' makes it work again. */
export function setControl(control, reason) {
  control.disabled = reason !== '';
  const label = control.closest('label');
  label.querySelector('.why')?.remove();
  if (!reason) return;
  const why = document.createElement('span');
  why.className = 'why';
  why.textContent = reason;
  label.append(why);
}
