// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The legend of the colours, and how often values occur.
import { cssColourAt, readable } from './colours.js';

const byId = (id) => document.getElementById(id);

/** Draws the bar of the legend, once. */
export function drawBar(name) {
  byId('legend-title').textContent = name;
  const bar = byId('legend-bar');
  const context = bar.getContext('2d');
  for (let y = 0; y < bar.height; ++y) {
    context.fillStyle = cssColourAt(1 - y / (bar.height - 1));
    context.fillRect(0, y, bar.width, 1);
  }
}

/** Sets the values at the bar, with a mark at the isovalue, or none where it is null. */
export function markLegend(least, greatest, isovalue) {
  const part = (value) => (greatest > least ? (value - least) / (greatest - least) : 0);
  const ticks = [0, 0.25, 0.5, 0.75, 1].map((t) => ({ at: t, value: least + t * (greatest - least) }));
  const shown = isovalue === null ? ticks
    : ticks.filter((t) => Math.abs(t.at - part(isovalue)) > 0.08);
  const spans = shown.map(({ at, value }) => [at, readable(value), '']);
  if (isovalue !== null) spans.push([part(isovalue), readable(isovalue), 'mark']);
  byId('legend-ticks').replaceChildren(...spans.map(([at, text, kind]) => {
    const span = document.createElement('span');
    span.style.bottom = `${100 * at}%`;
    span.textContent = text;
    span.className = kind;
    return span;
  }));
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

/** The picture on the stage with its legend, as a canvas. */
export function pictureWithLegend(stage, caption) {
  const source = byId('canvas');
  const scale = source.width / source.clientWidth;
  const canvas = document.createElement('canvas');
  canvas.width = source.width;
  canvas.height = source.height;
  const context = canvas.getContext('2d');
  stage.drawNow();
  context.drawImage(source, 0, 0);
  context.scale(scale, scale);
  const style = getComputedStyle(byId('stage'));
  context.fillStyle = style.color;
  context.font = `12px ${style.fontFamily}`;
  context.textBaseline = 'middle';
  const origin = source.getBoundingClientRect();
  const place = (element) => {
    const r = element.getBoundingClientRect();
    return { x: r.left - origin.left, y: r.top - origin.top, width: r.width, height: r.height };
  };
  if (!byId('legend').hidden) {
    const bar = place(byId('legend-bar'));
    context.drawImage(byId('legend-bar'), bar.x, bar.y, bar.width, bar.height);
    for (const text of [byId('legend-title'), ...byId('legend-ticks').children]) {
      const at = place(text);
      const mark = text.className === 'mark' ? '◂ ' : '';
      context.fillText(mark + text.textContent, at.x, at.y + at.height / 2);
    }
  }
  context.textAlign = 'right';
  context.fillText(caption, source.clientWidth - 16, source.clientHeight - 18);
  return canvas;
}
