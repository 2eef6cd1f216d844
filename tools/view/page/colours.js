// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The colour of a value: viridis, which is as light as the value is great, also for who sees no
// colours.

const stops = [0x440154, 0x482475, 0x414487, 0x355f8d, 0x2a788e, 0x21918c,
               0x22a884, 0x44bf70, 0x7ad151, 0xbddf26, 0xfde725];

/** [red, green, blue] from 0 to 255 of a part of the range, from 0 to 1. */
export function colourAt(part) {
  const at = Math.min(Math.max(part, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  const channel = (shift) => {
    const a = (stops[i] >> shift) & 255;
    const b = (stops[i + 1] >> shift) & 255;
    return a + (at - i) * (b - a);
  };
  return [channel(16), channel(8), channel(0)];
}

/** The same as a colour of CSS. */
export function cssColourAt(part) {
  return `rgb(${colourAt(part).map(Math.round).join(' ')})`;
}

const linear = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
const steps = 1024;
const table = new Float32Array(3 * steps);
for (let i = 0; i < steps; ++i) {
  table.set(colourAt(i / (steps - 1)).map((c) => linear(c / 255)), 3 * i);
}

/** Linear red, green and blue of each value, from 0 to 1. */
export function coloursOf(values, least, greatest) {
  const colours = new Float32Array(3 * values.length);
  const scale = greatest > least ? (steps - 1) / (greatest - least) : 0;
  for (let i = 0; i < values.length; ++i) {
    // A value that is no number has the first colour.
    const step = Math.min(Math.max(Math.round((values[i] - least) * scale) || 0, 0), steps - 1);
    colours[3 * i] = table[3 * step];
    colours[3 * i + 1] = table[3 * step + 1];
    colours[3 * i + 2] = table[3 * step + 2];
  }
  return colours;
}

/** A colour of style.css under a scheme: 'light', 'dark', or '' as the page has it. */
export function colourOf(name, scheme = '') {
  const probe = document.createElement('i');
  probe.className = scheme;
  probe.style.color = `var(--${name})`;
  document.body.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}

/** The numbers in a text with commas or spaces between them, or null. */
export function numbersIn(text) {
  const numbers = text.split(/[\s,]+/).filter((each) => each !== '').map(Number);
  return numbers.every(Number.isFinite) ? numbers : null;
}

/** Four digits, for readers; 0 for what is rounding beside the range of the data. */
export function readable(x, range = 0) {
  if (x === null || !Number.isFinite(x)) return 'not known';
  if (Math.abs(x) <= 1e-7 * range) return '0';
  const size = Math.abs(x);
  if (size >= 1e6 || size < 1e-4) return x.toExponential(3).replace(/\.?0+e/, 'e');
  return String(Number(x.toPrecision(4)));
}

/** A count with commas between thousands, which screen readers take for one number. */
export function readableCount(n) {
  return Math.round(n).toString().replace(/\B(?=(\d{3})+$)/g, ',');
}

/** A part of the range of the data, of two digits; its number where there is no range. */
export function percent(x, range) {
  return range > 0 ? `${Number(((100 * x) / range).toPrecision(2))} %` : readable(x);
}

/** A number as text with its unit, which may be '' or not known. */
export function withUnit(text, unit) {
  return unit ? `${text} ${unit}` : text;
}
