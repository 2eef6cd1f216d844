// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The picture as a file: the reader chooses its size, ground and what stands in it, and sees it before.
import { colourOf, readable, readableCount } from './colours.js';
import { drawLegend, fontOf, roundStep } from './legend.js';
import { withTexts } from './png_text.js';
import { setControl, showMessage } from './status.js';

const byId = (id) => document.getElementById(id);
const [least, most] = [64, 8192];
const preview = [420, 300];

/** Colours of lines and letters, and of the ground, null for none. */
const grounds = {
  page: () => {
    const scheme = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
    return { scheme, ground: colourOf('stage', scheme) };
  },
  white: () => ({ scheme: 'light', ground: '#ffffff' }),
  black: () => ({ scheme: 'dark', ground: '#000000' }),
  'none-light': () => ({ scheme: 'light', ground: null }),
  'none-dark': () => ({ scheme: 'dark', ground: null }),
};

export function download(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export class SavedPicture {
  title = '';
  /** { frame, legend, as for showLegend, or null; lengthUnit, or '' } */
  content = null;

  #stage;
  #address;
  #dialog = byId('picture-dialog');
  #fields = byId('picture-dialog').querySelector('form').elements;

  /** address: returns the address of the view */
  constructor(stage, address) {
    this.#stage = stage;
    this.#address = address;
    this.#dialog.addEventListener('input', ({ target }) => {
      if (target === this.#fields.preset) this.#takePreset();
      else if (target.type === 'number') this.#fields.preset.value = 'own';
      this.#check();
    });
    this.#dialog.addEventListener('close', () => {
      if (this.#dialog.returnValue === 'save') this.#save();
    });
  }

  /** Asks the reader, and saves. */
  ask() {
    this.#takePreset();
    const { legend } = this.content;
    setControl(this.#fields.legend, legend ? '' : 'nothing is coloured by values');
    this.#dialog.returnValue = '';
    this.#dialog.showModal();
    this.#check();
  }

  #takePreset() {
    const { preset, width, height } = this.#fields;
    if (preset.value === 'own') return;
    const canvas = byId('canvas');
    const size = preset.value === 'screen'
      ? [canvas.clientWidth, canvas.clientHeight].map((n) => Math.round(n * devicePixelRatio))
      : preset.value.split('x');
    [width.value, height.value] = size;
  }

  get #size() {
    return [this.#fields.width, this.#fields.height].map((field) => Number(field.value));
  }

  #check() {
    const fits = (n) => Number.isInteger(n) && n >= least && n <= most;
    const sentence = this.#size.every(fits) ? ''
      : `Width and height are whole numbers from ${least} to ${most}.`;
    for (const field of [this.#fields.width, this.#fields.height]) {
      const wrong = !fits(Number(field.value));
      field.setCustomValidity(wrong ? sentence : '');
      field.setAttribute('aria-invalid', String(wrong));
    }
    byId('picture-check').textContent = sentence;
    if (sentence) return;
    const scale = Math.min(...this.#size.map((n, d) => preview[d] / n));
    const drawn = this.#compose(scale);
    const shown = byId('picture-preview');
    [shown.width, shown.height] = [drawn.width, drawn.height];
    shown.getContext('2d').drawImage(drawn, 0, 0);
  }

  get #caption() {
    const { triangles, error_bound: bound } = this.content.frame;
    const parts = [`${readableCount(triangles)} triangles`];
    if (Number.isFinite(bound)) parts.push(`error at most ${readable(bound)}`);
    return parts.join(', ');
  }

  /** The picture, each length by a factor of what is chosen. */
  #compose(scale) {
    const [width, height] = this.#size.map((n) => Math.max(1, Math.round(n * scale)));
    const wants = (name) => this.#fields[name].checked && !this.#fields[name].disabled;
    const { scheme, ground } = grounds[this.#fields.ground.value]();
    const em = scale * Math.max(10, Math.min(...this.#size) / 45);
    const canvas = Object.assign(document.createElement('canvas'), { width, height });
    const context = canvas.getContext('2d');
    const lines = wants('address') ? linesOf(context, this.#address(), width - 2 * em, 0.8 * em) : [];
    const bottom = height - Math.ceil(lines.length > 0 ? (lines.length + 0.6) * em : 0);
    if (ground) {
      context.fillStyle = ground;
      context.fillRect(0, 0, width, height);
    }
    const drawn = this.#stage.drawSized(width, bottom, { ground, scheme, frame: wants('box') });
    context.drawImage(drawn, 0, 0);
    const colour = colourOf('text', scheme);
    if (wants('legend')) drawLegend(context, this.content.legend, em, bottom - em, em, colour);
    if (wants('scale')) {
      const perPoint = this.#stage.view.heightAtTarget / bottom;
      this.#drawScale(context, width, bottom, perPoint, em, colour);
    }
    context.fillStyle = colour;
    context.textAlign = 'left';
    context.textBaseline = 'alphabetic';
    if (wants('caption')) {
      context.font = fontOf(1.15 * em, true);
      context.fillText(this.title, em, 2 * em);
      context.font = fontOf(em);
      context.fillText(this.#caption, em, 3.5 * em);
    }
    context.font = fontOf(0.8 * em);
    lines.forEach((line, i) => context.fillText(line, em, bottom + (i + 0.8) * em));
    return canvas;
  }

  /** A bar of a round length. In perspective it holds at one depth, and says so. */
  #drawScale(context, width, bottom, perPoint, em, colour) {
    const length = roundStep((0.1 * width * perPoint));
    const points = length / perPoint;
    const right = width - 1.2 * em;
    const y = bottom - 1.2 * em;
    context.strokeStyle = context.fillStyle = colour;
    context.lineWidth = em / 6;
    context.beginPath();
    for (const x of [right - points, right]) {
      context.moveTo(x, y - 0.35 * em);
      context.lineTo(x, y + 0.35 * em);
    }
    context.moveTo(right - points, y);
    context.lineTo(right, y);
    context.stroke();
    context.font = fontOf(em);
    context.textAlign = 'right';
    context.textBaseline = 'alphabetic';
    const unit = this.content.lengthUnit || (length === 1 ? 'unit of length' : 'units of length');
    const place = this.#stage.view.isParallel ? '' : ' at the depth of the centre';
    context.fillText(`${readable(length)} ${unit}${place}`, right, y - 0.7 * em);
  }

  async #save() {
    const canvas = this.#compose(1);
    const png = await new Promise((resolve) => { canvas.toBlob(resolve, 'image/png'); });
    if (!png) {
      showMessage('The picture could not be saved: the browser has no memory for its size.');
      return;
    }
    download(withTexts(png, {
      Title: this.title, Description: this.#caption, Software: 'nestgrid', View: this.#address(),
    }), 'nestgrid.png');
  }
}

/** A text in lines of a width, broken behind signs that part its entries. */
function linesOf(context, text, width, size) {
  context.font = fontOf(size);
  const lines = [''];
  for (const part of text.split(/(?<=[&,])/)) {
    if (context.measureText(lines.at(-1) + part).width > width && lines.at(-1)) lines.push('');
    lines[lines.length - 1] += part;
  }
  return lines;
}
