// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Asks the program that served this page. A request that is aborted closes its connection, by which the
// program learns that nobody waits any more.

async function get(path, signal) {
  let response;
  try {
    response = await fetch(path, { cache: 'no-store', signal });
  } catch (error) {
    if (signal?.aborted) throw error;
    const lost = new Error('The program of this page does not answer: is it still running?');
    lost.isLost = true;
    throw lost;
  }
  if (!response.ok) throw new Error((await response.text()) || `error ${response.status}`);
  return response;
}

export class ServerEngine {
  takesFiles = false;
  stopsCheaply = true;

  async info() {
    return (await get('info')).json();
  }

  async frame(request, signal) {
    const response = await get(`frame?${request}`, signal);
    try {
      return await response.arrayBuffer();
    } catch (error) {
      if (!signal?.aborted) error.isLost = true;
      throw error;
    }
  }

  async pulse(signal) {
    return (await get('pulse', signal)).json();
  }
}
