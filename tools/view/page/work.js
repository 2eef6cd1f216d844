// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shows that the page works, after a time in which most frames are drawn: a bar, with the share that
// is done where it is known, and a button that cancels. Meanwhile the numbers are those of before.
const byId = (id) => document.getElementById(id);

/** Milliseconds before the bar appears, and before it goes behind the last frame. */
const patience = 300;
const lag = 150;

export class Work {
  #jobs = [];
  #coming = null;
  #leaving = null;

  constructor() {
    byId('cancel').addEventListener('click', () => this.#jobs.at(-1)?.cancel());
  }

  /**
   * doing: a sentence without a full stop; cancel: called when the reader asks for it
   * returns the job, for end()
   */
  begin(doing, cancel) {
    const job = { doing, cancel };
    this.#jobs.push(job);
    this.#show();
    this.#wait();
    return job;
  }

  /** Tells of the newest job. doing: as begin() takes it, share: from 0 to 1; each may be missing. */
  tell({ doing, share }) {
    const job = this.#jobs.at(-1);
    if (job) this.#show(doing || job.doing, share);
  }

  end(job) {
    this.#jobs = this.#jobs.filter((other) => other !== job);
    this.#busy(false);
    this.#wait();
  }

  #show(doing = this.#jobs.at(-1).doing, share = null) {
    byId('work-text').textContent = doing;
    if (share === null) byId('work-bar').removeAttribute('value');
    else byId('work-bar').value = share;
  }

  #wait() {
    clearTimeout(this.#coming);
    clearTimeout(this.#leaving);
    if (this.#jobs.length === 0) {
      this.#leaving = setTimeout(() => { byId('work').hidden = true; }, lag);
      return;
    }
    this.#coming = setTimeout(() => {
      byId('work').hidden = false;
      this.#busy(true);
    }, patience);
  }

  #busy(on) {
    for (const id of ['stage', 'numbers']) byId(id).setAttribute('aria-busy', String(on));
  }
}
