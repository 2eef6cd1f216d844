// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sliders and selections. They show a state and say which part of it the reader changes; while a
// slider is dragged the change is 'moving', when it is let go 'settled'.
import { percent, readable, readableCount, withUnit } from './colours.js';
import { FurtherControls } from './further.js';
import { collapses, diagonalOf, heldAt, isEmpty, listIn, seenOf } from './state.js';
import { setControl, setWhy } from './status.js';

const byId = (id) => document.getElementById(id);
const sliderSteps = 1000;

/** Scales between a value and the position of a slider, from 0 to 1. */
const linear = (from, to) => ({
  value: (t) => from + t * (to - from),
  position: (x) => (to > from ? (x - from) / (to - from) : 0),
});
const logarithmic = (from, to) => ({
  value: (t) => from * (to / from) ** t,
  position: (x) => (x > 0 ? Math.log(x / from) / Math.log(to / from) : 0),
});

/** What detail may be held at; each has a choice and controls. */
const details = ['triangles', 'error', 'distance', 'threshold'];
const trianglesScale = logarithmic(1000, 3000000);

/** A count of two digits. */
const rounded = (n) => {
  const unit = 10 ** Math.max(0, Math.floor(Math.log10(n)) - 1);
  return Math.round(n / unit) * unit;
};

export class Controls {
  #change;
  #state;
  #info;
  #playing = null;
  #further;
  /** The slider that the reader moves at the moment. */
  #held = null;

  /** change(changes, motion) */
  constructor(change) {
    this.#change = change;
    this.#further = new FurtherControls(byId('further-controls'), change);
    this.#slider('isovalue', (t) => ({ isovalue: this.#valueScale.value(t) }));
    this.#slider('triangles', (t) => ({ triangles: rounded(trianglesScale.value(t)) }));
    this.#slider('threshold', (t) => ({ threshold: t === 0 ? 0 : this.#thresholdScale.value(t) }));
    this.#slider('error', (t) => ({ error: this.#errorScale.value(t) }));
    this.#slider('distance', (t) => ({ distance: this.#distanceScale.value(t) }));
    this.#slider('positions', (t) => ({ positions: this.#distanceScale.value(t) }));
    this.#slider('slice-at', (t) => ({ at: this.#placeScale.value(t) }));
    this.#slider('lens-radius', (t) => ({ radius: this.#radiusScale.value(t) }));
    this.#slider('time', (t) => ({ time: this.#timeAt(t) }));
    for (const id of ['surface', 'cap', 'boundary', 'outlines', 'collapse']) {
      byId(id).addEventListener('change', (e) => change({ [id]: e.target.checked }, 'settled'));
    }
    for (const held of details) {
      byId(`by-${held}`).addEventListener('change', (e) => change({ detail: e.target.value }, 'settled'));
    }
    byId('lens').addEventListener('change', (e) => {
      change({ lens: e.target.value, centre: null }, 'settled');
    });
    byId('indicator').addEventListener('change', (e) => this.#chooseIndicator(e.target.value));
    byId('slice').addEventListener('change', (e) => this.#chooseSlice(e.target.value));
    byId('isovalue-number').addEventListener('change', (e) => {
      const value = Number(e.target.value.replace(',', '.'));
      const valid = e.target.value.trim() !== '' && Number.isFinite(value);
      e.target.setAttribute('aria-invalid', String(!valid));
      if (valid) change({ isovalue: value }, 'settled');
    });
    byId('more').addEventListener('change', (e) => {
      const more = listIn('more', e.target.value);
      this.#setMoreInvalid(more === null);
      if (more) change({ more }, 'settled');
    });
    byId('play').addEventListener('click', () => this.#play());
    byId('slice-face').addEventListener('click', () => change({ slice: 'view' }, 'settled'));
  }

  /** Forgets what belongs to the last field. */
  reset() {
    this.#stopPlaying();
    byId('isovalue-number').setAttribute('aria-invalid', 'false');
    this.#setMoreInvalid(false);
    this.#further.reset();
  }

  #setMoreInvalid(invalid) {
    byId('more').setAttribute('aria-invalid', String(invalid));
    byId('more-why').hidden = !invalid;
  }

  /** Offers the indicators of the field: those that the page has no text for by what they measure. */
  #offer({ indicators }) {
    const select = byId('indicator');
    const named = [...select.options].map((option) => option.value);
    for (const [name, measures] of indicators) {
      if (!named.includes(name)) select.add(new Option(measures, name));
    }
  }

  /** Shows a state. */
  show(state, info) {
    this.#state = state;
    this.#info = info;
    this.#offer(info);
    byId('surface').checked = state.surface;
    byId('outlines').checked = state.outlines;
    byId('boundary').checked = state.boundary;
    byId('collapse').checked = state.collapse;
    byId('cap').checked = state.cap;
    const held = heldAt(state);
    for (const detail of details) {
      byId(`by-${detail}`).checked = held === detail;
      byId(`${detail}-controls`).hidden = held !== detail;
    }
    for (const id of ['indicator', 'slice', 'lens']) byId(id).value = state[id];
    byId('isovalue-controls').hidden = !state.surface;
    byId('slice-controls').hidden = state.slice === 'none';
    byId('slice-face').hidden = state.slice !== 'view';
    byId('lens-controls').hidden = state.lens === 'off';
    byId('positions-controls').hidden = !info.curved;
    byId('time-section').hidden = info.times.length < 2;
    this.#place('isovalue', this.#valueScale.position(state.isovalue));
    this.#place('triangles', trianglesScale.position(state.triangles));
    this.#place('threshold', this.#thresholdScale.position(state.threshold));
    this.#place('error', this.#errorScale.position(state.error));
    this.#place('distance', this.#distanceScale.position(state.distance));
    this.#place('positions', this.#distanceScale.position(state.positions));
    this.#place('slice-at', this.#placeScale.position(state.at));
    this.#place('lens-radius', this.#radiusScale.position(state.radius));
    this.#place('time', linear(info.times[0], info.times.at(-1)).position(state.time));
    this.#showTexts(state, info);
    this.#further.show(seenOf(state, info));
    this.#showWhyNot(state, held);
  }

  /** Dims what means nothing at the moment, and says why. */
  #showWhyNot(state, held) {
    const nothing = isEmpty(state);
    for (const section of ['detail-section', 'lens-section', 'outlines-section']) {
      setWhy(section, nothing ? 'Nothing is drawn: choose the isosurface, a slice or the boundary.' : '');
    }
    if (nothing) return;
    const all = held === 'threshold' && state.threshold === 0;
    const own = held === 'error' || held === 'distance' ? `the ${held} decides` : '';
    const degree = this.#info.degree > 1 ? 'not for data of higher degree' : '';
    const flat = state.surface ? '' : 'only of an isosurface';
    setControl(byId('indicator'), degree || (all ? 'all detail is kept' : own));
    setControl(byId('by-distance'), degree || flat);
    setControl(byId('collapse'), degree || flat);
    setControl(byId('cap'), collapses(state) ? 'a collapsed surface stays open' : '');
    if (collapses(state)) setWhy('outlines-section', 'Collapsed triangles have no elements.');
  }

  #showTexts(state, info) {
    const range = info.greatest - info.least;
    byId('least').textContent = readable(info.least, range);
    byId('greatest').textContent = readable(info.greatest, range);
    if (document.activeElement !== byId('isovalue-number')) {
      byId('isovalue-number').value = readable(state.isovalue, range);
    }
    if (document.activeElement !== byId('more')) {
      byId('more').value = state.more.map((x) => readable(x, range)).join(', ');
    }
    const length = (x) => withUnit(readable(x), info.length_unit);
    const place = { view: 'distance from the centre', sphere: 'radius' }[state.slice] ?? state.slice;
    this.#say('isovalue', null, withUnit(readable(state.isovalue, range), info.unit));
    this.#say('triangles', 'triangles-text', `about ${readableCount(state.triangles)} triangles`);
    this.#say('threshold', 'threshold-text', this.#thresholdText(state, info));
    this.#say('error', 'error-text', `at most ${this.#shareText(state.error, info)}`);
    this.#say('distance', 'distance-text', `about ${length(state.distance)}`);
    this.#say('positions', 'positions-text', `at most ${length(state.positions)}`);
    this.#say('slice-at', 'slice-text', `${place} ${length(state.at)}`);
    this.#say('lens-radius', 'lens-text', `radius ${length(state.radius)}`);
    this.#say('time', 'time-text', `time ${readable(state.time)}`);
    byId('lens-hint').textContent = state.lens === 'cursor'
      ? 'Point at the surface, or aim at it with Ctrl and arrow keys.'
      : state.centre ? 'Click elsewhere to move it, or aim there and press Enter.'
        : 'Click on the surface, or aim at it and press Enter.';
  }

  /** Has a slider, and a text beside it, say what it is at. */
  #say(slider, beside, text) {
    byId(slider).setAttribute('aria-valuetext', text);
    if (beside) byId(beside).textContent = text;
  }

  #thresholdText(state, info) {
    if (state.indicator === 'visual' && !(info.degree > 1)) {
      const degrees = 2 * Math.asin(Math.min(state.threshold / 2, 1)) * (180 / Math.PI);
      return `folds up to ${readable(degrees)}°`;
    }
    const text = this.#shareText(state.threshold, info);
    return state.indicator === 'deviation' || info.degree > 1 ? `error at most ${text}` : text;
  }

  #shareText(x, { least, greatest }) {
    return `${readable(x)} (${percent(x, greatest - least)} of the range)`;
  }

  get #valueScale() {
    return linear(this.#info.least, this.#info.greatest);
  }
  get #thresholdScale() {
    const range = this.#state.indicator === 'visual' ? 2 : this.#info.greatest - this.#info.least;
    return logarithmic(range / 10000, range / 2);
  }
  get #errorScale() {
    const range = this.#info.greatest - this.#info.least;
    return logarithmic(range / 10000, range / 2);
  }
  get #distanceScale() {
    const diagonal = diagonalOf(this.#info.box);
    return logarithmic(diagonal / 20000, diagonal / 20);
  }
  get #radiusScale() {
    const diagonal = diagonalOf(this.#info.box);
    return linear(0.01 * diagonal, 0.3 * diagonal);
  }
  get #placeScale() {
    const { slice } = this.#state;
    const [low, high] = this.#info.box;
    const half = diagonalOf(this.#info.box) / 2;
    if (slice === 'sphere') return linear(half / 1000, half);
    if (slice === 'view') return linear(-half, half);
    const d = Math.max(['x', 'y', 'z'].indexOf(slice), 0);
    return linear(low[d], high[d]);
  }

  #timeAt(t) {
    const { times } = this.#info;
    return linear(times[0], times.at(-1)).value(t);
  }

  #chooseIndicator(indicator) {
    const changes = { indicator };
    const range = this.#info.greatest - this.#info.least;
    const visual = indicator === 'visual';
    if (visual !== (this.#state.indicator === 'visual')) changes.threshold = visual ? 0.1 : 0.01 * range;
    this.#change(changes, 'settled');
  }

  #chooseSlice(slice) {
    this.#state.slice = slice;
    this.#change({ slice, at: this.#placeScale.value(0.5) }, 'settled');
  }

  #slider(id, changesAt) {
    const slider = byId(id);
    const position = () => Number(slider.value) / sliderSteps;
    const move = (motion) => {
      this.#held = id;
      this.#change(changesAt(position()), motion);
      this.#held = null;
    };
    slider.addEventListener('input', () => move('moving'));
    slider.addEventListener('change', () => move('settled'));
  }

  #place(id, position) {
    const slider = byId(id);
    const value = String(Math.round(sliderSteps * Math.min(Math.max(position, 0), 1)));
    // A slider under the hand stays where the hand is: a key that moves it less than its value is
    // rounded to would move it never.
    if (id !== this.#held && !slider.matches(':active')) slider.value = value;
  }

  #stopPlaying() {
    clearInterval(this.#playing);
    this.#playing = null;
    byId('play').textContent = 'Play';
  }

  #play() {
    if (this.#playing) {
      this.#stopPlaying();
      this.#change({}, 'settled');
      return;
    }
    byId('play').textContent = 'Pause';
    const { times } = this.#info;
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) {
      this.#playing = setInterval(() => {
        const next = times.findIndex((time) => time > this.#state.time);
        this.#change({ time: times[Math.max(next, 0)] }, 'settled');
      }, 1000);
      return;
    }
    const length = times.at(-1) - times[0];
    const seconds = 2 * (times.length - 1);
    let last = performance.now();
    let at = this.#state.time >= times.at(-1) ? 0 : (this.#state.time - times[0]) / length;
    this.#playing = setInterval(() => {
      const now = performance.now();
      at = (at + (now - last) / 1000 / seconds) % 1;
      last = now;
      this.#change({ time: this.#timeAt(at) }, 'moving');
    }, 30);
  }
}
