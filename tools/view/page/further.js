// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame may be asked for beside values, slices and detail: a table, of which addresses,
// requests and controls are made. State and request have each under one name.
import { numbersIn, readable } from './colours.js';
import { setControl } from './status.js';

const polynomial = ({ degree }) => (degree > 1 ? 'not for data of higher degree' : '');
const onSurface = ({ surface }) => (surface ? '' : 'only of an isosurface');
const onCut = ({ slice, boundary }) => (
  slice === 'none' && !boundary ? 'only on a slice or the boundary' : '');
const staying = ({ takesAway }) => (takesAway ? 'not while triangles are taken away' : '');
const firstOf = (...whys) => whys.find((why) => why !== '') ?? '';

/**
 * Each: key; start, where the page begins, which asks for nothing; label; kind of its control, list,
 * number, choice or switch. why(seen): why it means nothing, or '', where seen is the state with held,
 * what detail is held at, takesAway, whether edges are collapsed, and degree. Lists have `count`
 * numbers or none; numbers are valid where valid() says so. text(state, info): what the request has
 * in the place of the value. slow: only for what has settled.
 */
export const further = [
  { key: 'band', start: [], count: 2, kind: 'list', label: 'Band between', hint: 'two values', why: () => '' },
  {
    key: 'lines', start: 0, kind: 'number', label: 'Isolines', hint: 'how many',
    valid: (x) => Number.isInteger(x) && x >= 0 && x <= 50,
    why: onCut,
    text: ({ lines }, { least, greatest }) => Array.from({ length: lines },
      (_, i) => least + ((i + 0.5) / lines) * (greatest - least)).join(','),
  },
  {
    key: 'colour_tolerance', start: 0, kind: 'number', label: 'Colours within', hint: 'as drawn',
    valid: (x) => x >= 0, slow: true,
    why: (seen) => firstOf(onCut(seen), staying(seen),
      seen.held === 'triangles' ? 'not for a number of triangles' : ''),
  },
  {
    key: 'slice_distance', start: 0, kind: 'number', label: 'Slice taken away within', hint: 'stays',
    valid: (x) => x >= 0,
    why: (seen) => (seen.slice === 'none' || !seen.takesAway ? 'only while a slice has fewer triangles' : ''),
  },
  {
    key: 'distance_field', start: false, kind: 'switch', label: 'Distance kept there and back',
    why: ({ held }) => (held === 'distance' ? '' : 'only for a distance'),
  },
  {
    key: 'measure', start: false, kind: 'switch', label: 'Measured against all data', slow: true,
    why: onSurface,
  },
  {
    key: 'blend', start: 1, kind: 'number', label: 'Nodes move, up to ×', hint: 'they jump',
    valid: (x) => x >= 1, why: polynomial,
  },
  {
    key: 'box', start: [], count: 6, kind: 'list', label: 'Finer in the box', hint: 'x, x, y, y, z, z',
    why: (seen) => firstOf(staying(seen), seen.blend > 1 ? 'not while nodes move' : ''),
  },
  {
    key: 'box_threshold', start: 0, kind: 'number', label: 'Threshold there', hint: 'all detail',
    valid: (x) => x >= 0,
    why: (seen) => firstOf(seen.box.length === 0 ? 'only in a box' : '', staying(seen),
      seen.blend > 1 ? 'not while nodes move' : ''),
  },
  {
    key: 'at_nodes', start: false, kind: 'switch', label: 'Vertices at nodes, without slivers',
    why: (seen) => firstOf(onSurface(seen), staying(seen)),
  },
  {
    key: 'cuts', start: 'auto', kind: 'choice', label: 'Edges are cut',
    choices: [['auto', 'as the detail needs it'], ['linear', 'within the error'], ['finest', 'where the data pass']],
    why: ({ surface, band }) => (surface || band.length > 0 ? '' : 'only of an isosurface'),
  },
];

const byKey = Object.fromEntries(further.map((each) => [each.key, each]));

export function furtherStart() {
  return Object.fromEntries(further.map(({ key, start }) => [key, start]));
}

/** The value in a text of the address or of a control; null where it is malformed. */
export function furtherIn(key, text) {
  const { kind, count, valid, choices } = byKey[key];
  if (kind === 'switch') return text === 'on';
  if (kind === 'choice') return choices.some(([name]) => name === text) ? text : null;
  const numbers = numbersIn(text);
  if (!numbers) return null;
  if (kind === 'list') return numbers.length === 0 || numbers.length === count ? numbers : null;
  if (numbers.length === 0) return byKey[key].start;
  return numbers.length === 1 && valid(numbers[0]) ? numbers[0] : null;
}

export const isFurther = (key) => key in byKey;

const isStart = (value, start) => JSON.stringify(value) === JSON.stringify(start);

/** What of it a request has. seen: as in the table */
export function furtherEntries(seen, info, motion) {
  return further
    .filter(({ key, start, why, slow }) => !isStart(seen[key], start) && why(seen) === ''
      && !(slow && motion !== 'settled'))
    .map(({ key, text }) => {
      const value = seen[key];
      return `${key}=${text ? text(seen, info) : value === true ? 'on' : value}`;
    });
}

export class FurtherControls {
  #inputs = new Map();

  /** change(changes, motion) */
  constructor(parent, change) {
    for (const each of further) {
      const input = this.#control(each);
      input.id = each.key;
      input.addEventListener('change', () => {
        const value = each.kind === 'switch' ? input.checked : furtherIn(each.key, input.value);
        input.setAttribute('aria-invalid', String(value === null));
        if (value !== null) change({ [each.key]: value }, 'settled');
      });
      const label = Object.assign(document.createElement('label'), { className: 'line' });
      label.append(Object.assign(document.createElement('span'), { textContent: each.label }), input);
      parent.append(label);
      this.#inputs.set(each.key, input);
    }
  }

  #control({ kind, hint, choices }) {
    if (kind === 'choice') {
      const select = document.createElement('select');
      for (const [name, text] of choices) select.add(new Option(text, name));
      return select;
    }
    return Object.assign(document.createElement('input'), kind === 'switch' ? { type: 'checkbox' }
      : { type: 'text', placeholder: hint, inputMode: kind === 'number' ? 'decimal' : 'text' });
  }

  /** Forgets what was malformed. */
  reset() {
    for (const input of this.#inputs.values()) input.setAttribute('aria-invalid', 'false');
  }

  /** seen: as in the table */
  show(seen) {
    for (const { key, start, kind, why } of further) {
      const input = this.#inputs.get(key);
      const value = seen[key];
      if (kind === 'switch') input.checked = value;
      else if (kind === 'choice') input.value = value;
      else if (document.activeElement !== input) {
        input.value = isStart(value, start) ? '' : [value].flat().map((x) => readable(x)).join(', ');
      }
      setControl(input, why(seen));
    }
  }
}
