// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Asks the reader for what a .raw file does not say about itself.
import { bytesOfType } from './readers/volume.js';

const form = `
  <form method="dialog">
    <h2>What is in this file?</h2>
    <p class="raw-name"></p>
    <p class="line"><label>Samples along x, y, z
      <input name="samples" required placeholder="256 256 128" autocomplete="off"></label></p>
    <p class="line"><label>Type of a sample <select name="type"></select></label></p>
    <p class="line"><label>Distances of samples along x, y, z
      <input name="spacing" value="1 1 1" required autocomplete="off"></label></p>
    <p class="line"><label>
      <input type="checkbox" name="bigEndian"> Most significant byte first</label></p>
    <p class="raw-check" role="status"></p>
    <p class="buttons"><button value="open">Open</button>
      <button value="cancel" formnovalidate>Cancel</button></p>
  </form>`;

const numbersOf = (text) =>
  text
    .trim()
    .split(/[\s,;x]+/)
    .map(Number);

function formatOf(fields) {
  return {
    samples: numbersOf(fields.samples.value),
    type: fields.type.value,
    spacing: numbersOf(fields.spacing.value),
    bigEndian: fields.bigEndian.checked,
  };
}

/** Why a file does not have a format, or nothing. */
function objection(file, { samples, type, spacing }) {
  const areThree = (list, fits) => list.length === 3 && list.every(fits);
  if (!areThree(samples, (n) => Number.isInteger(n) && n >= 2))
    return 'Give three counts of samples.';
  if (!areThree(spacing, (x) => Number.isFinite(x) && x > 0))
    return 'Give three distances above 0.';
  const bytes = samples.reduce((product, n) => product * n, bytesOfType[type]);
  return bytes === file.size ? '' : `These samples take ${bytes} bytes; the file has ${file.size}.`;
}

/**
 * signal: an AbortSignal, which closes the dialog
 * returns a promise of { samples, type, spacing, bigEndian }, which fails where the reader cancels
 */
export function askRawFormat(file, signal) {
  const dialog = document.createElement('dialog');
  dialog.id = 'raw-dialog';
  dialog.innerHTML = form;
  const fields = dialog.querySelector('form').elements;
  fields.type.append(...Object.keys(bytesOfType).map((type) => new Option(type)));
  dialog.querySelector('.raw-name').textContent = `${file.name}, ${file.size} bytes`;
  const check = () => {
    const text = objection(file, formatOf(fields));
    dialog.querySelector('.raw-check').textContent = text;
    fields.samples.setCustomValidity(text);
  };
  dialog.addEventListener('input', check);
  document.body.append(dialog);
  dialog.showModal();
  signal?.addEventListener('abort', () => dialog.close('cancel'));
  return new Promise((resolve, reject) => {
    dialog.addEventListener('close', () => {
      const format = formatOf(fields);
      dialog.remove();
      if (dialog.returnValue === 'open') resolve(format);
      else
        reject(new Error(`${file.name} does not describe itself: give its samples and their type`));
    });
  });
}
