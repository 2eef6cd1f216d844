// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the reader has chosen: as an object, in the address of the page, and as a request.
import { numbersIn } from './colours.js';
import { furtherEntries, furtherIn, furtherStart, isFurther } from './further.js';

export function diagonalOf(box) {
  return Math.hypot(...box[1].map((x, d) => x - box[0][d]));
}

function middleOf([low, high]) {
  return low.map((x, d) => (x + high[d]) / 2);
}

/** Of what one file may have several of; null where it has one, or the first is in the picture. */
const noChoice = { array: null, component: null, frame: null };

/** Where the page of a field begins. */
export function defaultState(info) {
  const [low, high] = info.box;
  return {
    surface: true,
    isovalue: info.isovalue,
    more: [],
    cap: false,
    detail: 'triangles',
    triangles: 50000,
    threshold: 0.01 * (info.greatest - info.least),
    error: 0.02 * (info.greatest - info.least),
    distance: diagonalOf(info.box) / 500,
    positions: diagonalOf(info.box) / 500,
    collapse: false,
    indicator: 'offset',
    outlines: false,
    slice: 'none',
    at: (low[2] + high[2]) / 2,
    normal: [0, 0, 1],
    boundary: false,
    lens: 'off',
    radius: 0.08 * diagonalOf(info.box),
    centre: null,
    ...furtherStart(),
    time: info.times[0],
    projection: 'perspective',
    camera: null,
    file: null,
    ...noChoice,
  };
}

/** What is chosen of a file, as a part of the state. */
export function chosenOf({ offers, choice }) {
  if (!offers) return noChoice;
  return {
    array: offers.arrays.length > 1 ? choice.array : null,
    component: offers.components > 1 ? choice.component || null : null,
    frame: offers.frames > 1 ? choice.frame || null : null,
  };
}

/** What an address chooses of these files; nothing where it is that of another file. */
export function choiceFromAddress(hash, files) {
  const entries = new URLSearchParams(hash.replace(/^#/, ''));
  const choice = {};
  if (!files.some(({ name }) => name === entries.get('file'))) return choice;
  for (const key of Object.keys(noChoice)) {
    if (!entries.has(key)) continue;
    const text = entries.get(key);
    choice[key] = key === 'array' || text === 'magnitude' ? text : Number(text);
  }
  return choice;
}

const choices = {
  detail: ['triangles', 'error', 'distance', 'threshold'],
  slice: ['none', 'x', 'y', 'z', 'view', 'sphere'],
  lens: ['off', 'cursor', 'click'],
  projection: ['perspective', 'parallel'],
};
/** Lists of numbers: how many, at least and at most. */
const lists = { more: [0, 19], normal: [3, 3], centre: [3, 3], camera: [9, 9] };

/** The numbers in a text for a part of the state; null also where they are too few or too many. */
export function listIn(key, text) {
  const numbers = numbersIn(text);
  const [least, most] = lists[key];
  return numbers && numbers.length >= least && numbers.length <= most ? numbers : null;
}

/** The state in an address, #key=value&..., on top of where a page begins; what is malformed does not
    count. Indicators are those of the field, [name, what it measures]. */
export function stateFromAddress(hash, start, indicators = []) {
  const state = { ...start };
  for (const [key, text] of new URLSearchParams(hash.replace(/^#/, ''))) {
    if (!(key in state)) continue;
    if (key === 'indicator') {
      if (indicators.some(([name]) => name === text)) state[key] = text;
    } else if (isFurther(key)) {
      state[key] = furtherIn(key, text) ?? state[key];
    } else if (choices[key]) {
      if (choices[key].includes(text)) state[key] = text;
    } else if (typeof state[key] === 'boolean') {
      state[key] = text === 'on';
    } else if (lists[key]) {
      state[key] = listIn(key, text) ?? state[key];
    } else if (text !== '' && Number.isFinite(Number(text))) {
      state[key] = Number(text);
    }
  }
  if (state.triangles < 1) state.triangles = start.triangles;
  if (state.threshold < 0) state.threshold = start.threshold;
  for (const key of ['error', 'distance', 'positions']) {
    if (!(state[key] > 0)) state[key] = start[key];
  }
  if (state.radius < 0) state.radius = start.radius;
  return state;
}

/** The address of a state: what differs from where a page begins, or all of it. */
export function addressOf(state, start = {}) {
  const short = (x) => String(Number(x.toPrecision(9)));
  const entries = [];
  for (const [key, value] of Object.entries(state)) {
    if (value === null || JSON.stringify(value) === JSON.stringify(start[key])) continue;
    if (Array.isArray(value)) entries.push(`${key}=${value.map(short).join(',')}`);
    else if (typeof value === 'boolean') entries.push(`${key}=${value ? 'on' : 'off'}`);
    else entries.push(`${key}=${typeof value === 'number' ? short(value) : encodeURIComponent(value)}`);
  }
  return `#${entries.join('&')}`;
}

/** An address that chooses nothing of a file. */
export function addressWithoutChoice(hash) {
  const entries = hash.replace(/^#/, '').split('&');
  return `#${entries.filter((entry) => !(entry.split('=')[0] in noChoice)).join('&')}`;
}

/** The plane of the slice, { point, normal }, or null. */
export function planeOf({ slice, at, normal }, { box: [low, high] }) {
  if (slice === 'none' || slice === 'sphere') return null;
  if (slice === 'view') {
    return { point: middleOf([low, high]).map((x, d) => x + at * normal[d]), normal };
  }
  const along = ['x', 'y', 'z'].map((axis) => (axis === slice ? 1 : 0));
  return { point: along.map((x) => x * at), normal: along };
}

/** Whether nothing is to be drawn. */
export function isEmpty({ surface, slice, boundary, band }) {
  return !surface && slice === 'none' && !boundary && band.length === 0;
}

/** What detail is held at: a distance is that of an isosurface. */
export function heldAt({ detail, surface }) {
  return detail === 'distance' && !surface ? 'triangles' : detail;
}

/** Whether triangles of an isosurface are taken away while the error is kept. */
export function collapses(state) {
  return state.collapse && state.surface && state.detail === 'error';
}

/** Whether the isosurface is closed at the boundary: one that is collapsed stays open. */
export function caps(state) {
  return state.cap && state.surface && !collapses(state);
}

/** The state with what follows from it, for further.js. */
export function seenOf(state, { degree }) {
  return { ...state, held: heldAt(state), takesAway: collapses(state), degree };
}

/** Errors and distances have indicators of their own. */
function detailOf(state) {
  const held = heldAt(state);
  if (held === 'distance') return [`distance=${state.distance}`];
  if (held === 'error') return [`error=${state.error}`, ...(collapses(state) ? ['collapse=on'] : [])];
  const number = held === 'triangles' ? Math.round(state.triangles) : state.threshold;
  return [`${held}=${number}`, `indicator=${state.indicator}`];
}

/** A request as frame_request.hpp describes it, or null where nothing is to be drawn. */
export function requestOf(state, info, motion) {
  if (isEmpty(state)) return null;
  const entries = [];
  if (state.surface) entries.push(`isovalue=${[state.isovalue, ...state.more].join(',')}`);
  if (state.boundary) entries.push('boundary=on');
  if (state.slice === 'sphere') {
    entries.push(`sphere=${[...middleOf(info.box), state.at].join(',')}`);
  } else if (state.slice === 'view') {
    const { point, normal } = planeOf(state, info);
    entries.push(`plane=${[...point, ...normal].join(',')}`);
  } else if (state.slice !== 'none') {
    entries.push(`axis=${state.slice}`, `at=${state.at}`);
  }
  entries.push(...detailOf(state), `motion=${motion}`, 'normals=int8');
  if (state.lens !== 'off' && state.centre) {
    entries.push(`lens=${[...state.centre, state.radius].join(',')}`, 'slope=1');
  }
  if (info.times.length > 1) entries.push(`time=${state.time}`);
  if (caps(state)) entries.push('cap=on');
  if (info.curved) entries.push(`position_error=${state.positions}`);
  if (state.outlines && !collapses(state)) entries.push('outlines=on');
  if ((state.surface || state.band.length > 0) && motion === 'settled') entries.push('report=on');
  entries.push(...furtherEntries(seenOf(state, info), info, motion));
  return entries.join('&');
}
