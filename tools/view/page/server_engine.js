// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Asks the program that served this page.

async function get(path) {
  let response;
  try {
    response = await fetch(path, { cache: 'no-store' });
  } catch {
    throw new Error('nestgrid view does not answer: is it still running?');
  }
  if (!response.ok) throw new Error((await response.text()) || `error ${response.status}`);
  return response;
}

export class ServerEngine {
  takesFiles = false;

  async info() {
    return (await get('info')).json();
  }

  async frame(request) {
    return (await get(`frame?${request}`)).arrayBuffer();
  }
}
