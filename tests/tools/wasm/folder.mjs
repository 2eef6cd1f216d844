// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the tests of the folder explore have in common. Its modules are those of the page.
import { readFileSync } from 'node:fs';
import { File } from 'node:buffer';
import { basename, join } from 'node:path';
import { pathToFileURL } from 'node:url';

/** A module of a folder. */
export const load = (folder, module) => import(pathToFileURL(join(folder, module)));

/** A file of this machine as a page gets it. */
export const fileAt = (path) => new File([readFileSync(path)], basename(path));

export const compileCore = (folder) =>
  WebAssembly.compile(readFileSync(join(folder, 'nestgrid.wasm')));

/** Whether a text is one clear sentence. */
export const isSentence = (text) => text.length > 10 && text.length < 400 && !text.includes('\n');
