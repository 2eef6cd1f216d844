// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The legend of the colours, beside the picture and in it, and how often values occur.
import { cssColourAt, readable } from './colours.js';

const byId = (id) => document.getElementById(id);

/** Fills a rectangle with the colours, the least value at its bottom. */
function fillBar(context, x, y, width, height) {
  for (let row = 0; row < height; ++row) {
    context.fillStyle = cssColourAt(1 - row / (height - 1));
    context.fillRect(x, y + row, width, 1);
  }
}

/**
 * The values at the bar: the ends, round ones between them, and marks, which may lie outside.
 * returns [{ part, from 0 to 1; text; marks }]
 */
export function ticksOf(least, greatest, wanted) {
  const range = greatest - least;
  const part = (value) => (range > 0 ? (value - least) / range : 0);
  const ends = range > 0 ? [least, greatest] : [least];
  const marks = wanted.filter((mark) => mark >= least && mark <= greatest);
  const step = roundStep(range / 4);
  const between = [];
  for (let i = Math.ceil(least / step); range > 0 && i * step < greatest; ++i) between.push(i * step);
  // Texts do not touch: a mark goes before an end, an end before a round value.
  const shown = [];
  for (const value of [...marks, ...ends, ...between]) {
    if (shown.every((other) => Math.abs(part(other) - part(value)) > 0.09)) shown.push(value);
  }
  return shown.map((value) => ({
    part: part(value), text: readable(value, range), marks: marks.includes(value) }));
}

/** The next of 1, 2, 5, 10, ... from a number upwards. */
export function roundStep(x) {
  const unit = 10 ** Math.floor(Math.log10(x));
  return unit * ([1, 2, 5].find((step) => step * unit >= x * (1 - 1e-9)) ?? 10);
}

/** Shows the legend of { field, unit, least, greatest, marks }, or none. */
export function showLegend(legend) {
  byId('legend').hidden = !legend;
  if (!legend) return;
  byId('legend-title').textContent = titleOf(legend);
  const bar = byId('legend-bar');
  fillBar(bar.getContext('2d'), 0, 0, bar.width, bar.height);
  byId('legend-ticks').replaceChildren(...ticksOf(legend.least, legend.greatest, legend.marks)
    .map(({ part, text, marks }) => {
      const span = document.createElement('span');
      span.style.bottom = `${100 * part}%`;
      span.textContent = text;
      span.className = marks ? 'mark' : '';
      return span;
    }));
}

const titleOf = ({ field, unit }) => (unit ? `${field} (${unit})` : field);

/**
 * Draws the legend into a picture, from its lower left corner.
 * em: the size of its text; colour: of its text
 */
export function drawLegend(context, legend, left, bottom, em, colour) {
  const [x, y, width, height] = [left, bottom, 1.4 * em, 14 * em].map(Math.round);
  fillBar(context, x, y - height, width, height);
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = em / 13;
  context.strokeRect(x, y - height, width, height);
  context.textAlign = 'left';
  context.textBaseline = 'middle';
  for (const { part, text, marks } of ticksOf(legend.least, legend.greatest, legend.marks)) {
    context.font = fontOf(em, marks);
    context.fillText(marks ? `◂ ${text}` : text, x + width + 0.6 * em, y - part * height);
  }
  context.font = fontOf(em, true);
  context.fillText(titleOf(legend), x, y - height - 1.4 * em);
}

/** The font of a text in a picture. */
export function fontOf(em, bold = false) {
  return `${bold ? '600 ' : ''}${em}px system-ui, "DejaVu Sans", sans-serif`;
}

/** Draws how often values occur, on a scale of roots, each in the colour of its value. */
export function drawHistogram(info) {
  const canvas = byId('histogram');
  const { counts, least, greatest } = info.histogram;
  canvas.hidden = counts.length === 0;
  if (canvas.hidden) return;
  canvas.width = counts.length * 4;
  const context = canvas.getContext('2d');
  context.clearRect(0, 0, canvas.width, canvas.height);
  const range = info.greatest - info.least;
  // The ends are often the surroundings of what was measured.
  const most = Math.max(...counts.slice(1, -1), 1);
  counts.forEach((count, i) => {
    const value = least + ((i + 0.5) / counts.length) * (greatest - least);
    const x = ((value - info.least) / range) * canvas.width;
    const width = (canvas.width / counts.length) * ((greatest - least) / range);
    const height = canvas.height * Math.min(1, Math.sqrt(count / most));
    context.fillStyle = cssColourAt((value - info.least) / range);
    context.fillRect(x - width / 2, canvas.height - height, width, height);
  });
}
