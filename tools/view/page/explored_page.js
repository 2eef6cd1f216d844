// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page of a field: each frame is what the controls ask for.
import { Controls } from './controls.js';
import { percent, readable, readableCount, withUnit } from './colours.js';
import { FrameLoop } from './frame.js';
import { furtherStart } from './further.js';
import { drawHistogram } from './legend.js';
import { Picture } from './picture.js';
import { addressOf, chosenOf, defaultState, heldAt, planeOf, requestOf, stateFromAddress } from './state.js';
import { showEmpty, showMessage, showNumbers, tell } from './status.js';

const byId = (id) => document.getElementById(id);

/** What a field is, in one sentence. */
function describe({ samples, nodes, box: [low, high], length_unit: unit, space, least, greatest }) {
  const range = greatest - least;
  const count = samples > 0 ? `${readableCount(samples)} samples` : `${readableCount(nodes)} nodes`;
  const size = withUnit(low.map((x, d) => readable(high[d] - x)).join(' × '), unit);
  const place = space ? `${size} in ${space}` : size;
  return `${count}, ${place}, values from ${readable(least, range)} to ${readable(greatest, range)}`;
}

/** Why a frame that has settled has not about as many triangles as were asked for; '' where it has. */
function whyNot(state, { triangles, threshold }) {
  const { triangles: goal, lens, centre } = state;
  if (heldAt(state) !== 'triangles' || triangles === 0) return '';
  const most = readableCount(goal);
  if (triangles > goal) {
    return lens !== 'off' && centre
      ? `The lens alone takes more than ${most} triangles: make it smaller.`
      : `No threshold gives as few as ${most} triangles.`;
  }
  if (threshold === 0) return triangles < 0.9 * goal ? 'This is all of the surface: the data have no more detail.' : '';
  return triangles < 0.9 * goal
    ? `Much detail is alike: the next finer surface has more than ${most} triangles.` : '';
}

/** What detail was held at, as a row of numbers: [name, meaning]. */
const heldNames = {
  triangles: ['threshold', 'Detail up to this is left out'],
  threshold: ['threshold', 'Detail up to this is left out'],
  error: ['error asked for', 'The data differ from their value on the surface by no more'],
  distance: ['distance asked for', 'From the surface of all data, an estimate'],
};

const nearnessMeans = 'The error in percent of the range of the data, and about how far it is from the surface of all '
  + 'data, where that is measured: when nothing moves, for an error or a distance';

/** How near a frame is to the data: the error as a part of their range, and the distance where it is told. */
function nearness({ error_bound: bound, bound_says_nothing: nothing, distance }, range, unit) {
  const parts = [];
  if (!nothing && Number.isFinite(bound)) parts.push(percent(bound, range));
  if (distance !== null) parts.push(withUnit(readable(Number(distance.toPrecision(2))), unit));
  return parts.join(' · ');
}

/** How far isosurfaces were found to be off, as rows of numbers. */
function measuredErrors({ parts }, range, unit) {
  const surfaces = parts.filter((part) => part.measured_error !== undefined);
  if (surfaces.length === 0) return [];
  const list = (text) => surfaces.map(text).join(' · ');
  const there = (part) => Math.max(part.measured_distance ?? Infinity, part.measured_back ?? Infinity);
  return [
    ['measured', 'error measured', list((part) => percent(part.measured_error, range)),
      'The greatest that was met on the isosurfaces, in percent of the range of the data'],
    ['off', 'distance measured', list((part) => withUnit(readable(there(part)), unit)),
      'The greatest that was met between the isosurfaces and those of all data, there and back'],
  ];
}

/** Area and volume of isosurfaces as rows of numbers, where they have been measured. */
function measures({ parts }, unit) {
  const surfaces = parts.filter(({ area }) => area !== undefined);
  if (surfaces.length === 0) return [];
  const list = (name, power) => surfaces.map((part) => (part[name] === null
    ? 'open' : withUnit(readable(part[name]), unit && `${unit}${power}`))).join(' · ');
  return [
    ['area', 'area', list('area', '²'), 'Of the band, and of the isosurfaces in the order of their values'],
    ['volume', 'volume', list('volume', '³'), 'Where the data are greater: of surfaces that are closed'],
  ];
}

export class ExploredPage {
  #info;
  #state;
  #picture;
  #controls;
  #loop;
  #shown = null;
  /** The states of the frame that was asked for last, and of the one in the picture. */
  #asked = null;
  #seen = null;
  #interrupted = false;
  #rest = null;
  #namesFiles;

  /** Called when the engine is not there any more. */
  lost = () => {};

  constructor(engine, work) {
    this.#namesFiles = engine.takesFiles;
    this.#picture = new Picture({
      moved: () => this.#remember(),
      reset: () => this.#change({ camera: null }, 'settled'),
      project: (projection) => {
        this.#state.projection = projection;
        this.#remember();
      },
      address: () => addressOf({ ...this.#state, camera: this.stage.camera }),
      hovered: (hit) => this.#hover(hit),
      clicked: (hit) => {
        if (hit && this.#state.lens === 'click') this.#change({ centre: hit.point }, 'settled');
      },
      sized: (factor) => {
        if (this.#state.lens !== 'off') this.#change({ radius: factor * this.#state.radius }, 'settled');
      },
    });
    this.#controls = new Controls((changes, motion) => this.#change(changes, motion));
    this.#loop = new FrameLoop(engine, work, {
      request: (motion) => {
        this.#asked = { ...this.#state };
        return requestOf(this.#asked, this.#info, motion);
      },
      show: (frame, how) => this.#show(frame, how),
      fail: (error) => this.#fail(error),
      cancelled: () => this.#goBack('Drawing was cancelled. Change something to draw again.'),
    });
    addEventListener('hashchange', () => {
      if (this.#info && location.hash !== addressOf(this.#state, this.#start)) this.#restore();
    });
  }

  /**
   * Shows another field: nothing of the last one stays, unless it is of the same file.
   * changed: what of the choice in a file is another one, 'frame', 'component' or 'array'; null where
   *   the file is another one
   */
  begin(info, changed = null) {
    const kept = changed && { ...this.#state, camera: this.stage.camera };
    this.#loop.forget();
    clearTimeout(this.#rest);
    showMessage('');
    showEmpty('');
    this.#picture.clear();
    showNumbers([]);
    this.#controls.reset();
    this.#seen = null;
    this.#shown = null;
    this.#interrupted = false;
    // Sliders and colours span the usual values.
    const [least, greatest] = info.usual_range;
    this.#info = { ...info, least, greatest };
    this.#picture.setTitle(info.title);
    byId('subtitle').textContent = describe(info);
    document.querySelectorAll('.field-name').forEach((e) => { e.textContent = `“${info.name}”`; });
    drawHistogram(this.#info);
    this.stage.setBox(info.box);
    this.#restore(kept && this.#stateBehind(kept, changed));
    if (changed) this.#remember();
  }

  /** Values of one frame say something of another one, those of a component or array do not. */
  #stateBehind(kept, changed) {
    if (changed === 'frame') return kept;
    const { isovalue, more, threshold, error, detail } = this.#start;
    return { ...kept, ...furtherStart(), isovalue, more, threshold, error, detail };
  }

  /** Draws what a lost engine has not drawn. */
  resume() {
    if (this.#interrupted) this.#loop.want('settled');
    this.#interrupted = false;
  }

  /** The frame in the picture, null where it is empty, with what was asked for. */
  get shown() {
    return this.#shown;
  }
  get idle() {
    return this.#loop.idle;
  }
  get stage() {
    return this.#picture.stage;
  }

  get #start() {
    return defaultState(this.#info);
  }

  #restore(state = null) {
    this.#state = state ?? stateFromAddress(location.hash, this.#start, this.#info.indicators);
    Object.assign(this.#state, chosenOf(this.#info));
    this.#picture.project(this.#state.projection);
    if (this.#namesFiles) this.#state.file = this.#info.title;
    this.stage.look(this.#state.camera);
    this.#showControls();
    this.#loop.want('settled');
  }

  #showControls() {
    this.#controls.show(this.#state, this.#info);
    const { lens, centre, radius } = this.#state;
    this.stage.setLens(lens !== 'off' && centre ? { centre, radius } : null);
  }

  #change(changes, motion) {
    if (changes.slice === 'view') changes.normal = this.stage.towardsReader;
    Object.assign(this.#state, changes);
    this.#showControls();
    this.#loop.want(motion);
    if (motion === 'settled') this.#remember();
  }

  #remember() {
    if (!this.#state) return;
    this.#state.camera = this.stage.camera;
    history.replaceState(null, '', addressOf(this.#state, this.#start));
  }

  #fail(error) {
    if (error.isLost) {
      this.#interrupted = true;
      this.lost();
      return;
    }
    this.#goBack('There is no picture.');
    showMessage(error.message);
  }

  /** Chooses what the picture shows, because what was chosen has not been drawn. */
  #goBack(why) {
    if (!this.#seen) {
      showEmpty(why);
      return;
    }
    this.#state = { ...this.#seen, camera: this.stage.camera };
    this.#showControls();
    this.#remember();
  }

  #show(frame, how) {
    showMessage('');
    this.#seen = this.#asked;
    this.#shown = { frame, ...how };
    if (!frame) {
      this.#picture.clear();
      showNumbers([]);
      showEmpty('Nothing is chosen: switch on the isosurface, or choose a slice or the boundary.');
      return;
    }
    showEmpty(frame.triangles > 0 ? '' : 'There is nothing here: no data have this value.');
    const { name, least, greatest, unit = '', length_unit: lengthUnit = '' } = this.#info;
    const range = greatest - least;
    const bound = frame.bound_says_nothing ? null : frame.error_bound;
    this.#picture.show(frame, {
      field: name, unit, lengthUnit, least, greatest, bound,
      isovalues: this.#seen.surface ? [this.#seen.isovalue, ...this.#seen.more] : [],
      plane: planeOf(this.#seen, this.#info),
    });
    this.#showNumbers(frame, bound === null ? 'the bound says nothing here' : readable(bound, range), how);
  }

  #showNumbers(frame, bound, { motion }) {
    const { least, greatest, length_unit: lengthUnit } = this.#info;
    const within = nearness(frame, greatest - least, lengthUnit);
    if (motion === 'settled') {
      const near = within === '' ? '' : `, within ${within}`;
      tell('frame', `${readableCount(frame.triangles)} triangles, error at most: ${bound}${near}`);
    }
    const why = motion === 'settled' ? whyNot(this.#seen, frame) : '';
    byId('triangles-why').textContent = why;
    byId('triangles-why').hidden = why === '';
    const held = heldAt(this.#seen);
    const [name, meaning] = heldNames[held];
    const asked = held === 'error' || held === 'distance' ? this.#seen[held] : frame.threshold;
    showNumbers([
      ['triangles', 'triangles', readableCount(frame.triangles)],
      ['bound', 'error at most', bound, 'On the surface, the data differ from its value by no more'],
      ...(within === '' ? [] : [['within', 'within', within, nearnessMeans]]),
      ...(this.#info.jump > 1e-6 * (greatest - least) ? [['jump', 'data jump by', readable(this.#info.jump),
        'Between elements: the error may be greater by this than what was asked for']] : []),
      ...(this.#info.curved ? [['positions', 'points off by', withUnit(readable(frame.position_bound), lengthUnit),
        'Points of the surface are no farther from their places in the curved elements']] : []),
      ...measuredErrors(frame, greatest - least, lengthUnit),
      ...measures(frame, lengthUnit),
      ['threshold', name, readable(asked), meaning],
      ['visited', 'visited', `${readableCount(frame.visited)} elements`,
        'Elements that the search entered'],
      ['ms', 'extraction', `${readable(1000 * frame.seconds)} ms`, 'Time to extract the surface'],
    ]);
  }

  #hover(hit) {
    if (!hit || this.#state.lens !== 'cursor') return;
    this.#change({ centre: hit.point }, 'moving');
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => this.#change({}, 'settled'), 250);
  }
}
