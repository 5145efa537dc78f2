// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

const TICK_MS = 40;
/// Number of moments of a minute that plots show after a jump.
const MOMENTS = 120;

/// Plays recordings: the current frame and the speed. Frames are requested one at a time, so a slow
/// machine shows fewer of them.
export class Player {
  /// `take(states, is_leap)` receives the states up to the current frame.
  constructor(film, take) {
    this.film = film;
    this.take = take;
    this.place = 0; // Frame number; its fraction is progress to the next one.
    this.shown = -1;
    this.speed = 1;
    this.plays = false;
    this.controller = "";
    this.busy = false;
    this.leap = true;
    this.last_ms = performance.now();
    setInterval(() => this.tick(), TICK_MS);
  }

  get frame() {
    return Math.floor(this.place);
  }
  time_s(frame = this.frame) {
    return frame * this.film.period_s;
  }

  play(plays) {
    this.plays = plays;
    if (plays && this.frame >= this.film.frames - 1) {
      this.go_to(0);
    }
  }
  /// Moves to a frame and restarts the plots.
  go_to(frame) {
    this.place = Math.min(Math.max(frame, 0), this.film.frames - 1);
    this.leap = true;
    this.ask();
  }
  step(frames) {
    this.plays = false;
    this.place = Math.min(Math.max(this.frame + frames, 0), this.film.frames - 1);
    this.ask();
  }
  choose(controller) {
    this.controller = controller;
    this.go_to(this.frame);
  }

  tick() {
    const now_ms = performance.now();
    if (this.plays) {
      this.place += (now_ms - this.last_ms) / 1e3 * this.speed / this.film.period_s;
      if (this.place >= this.film.frames - 1) {
        this.place = this.film.frames - 1;
        this.plays = false;
      }
    }
    this.last_ms = now_ms;
    this.ask();
  }

  ask() {
    const { frame, leap } = this;
    if (this.busy || (frame === this.shown && !leap)) {
      return;
    }
    this.busy = true;
    this.leap = false;
    const step = leap ? Math.max(Math.ceil(60 / this.film.period_s / MOMENTS), 1) : 1;
    const where = new URLSearchParams({ frame, step, count: leap ? MOMENTS : 1,
      controller: this.controller });
    fetch(`/states?${where}`)
      .then(async (answer) => {
        if (!answer.ok) {
          throw new Error((await answer.text()).trim());
        }
        const states = await answer.json();
        this.shown = frame;
        this.take(states, leap, "");
      })
      .catch((error) => {
        this.plays = false;
        this.shown = frame;
        this.take([], leap, `spm_view does not answer: ${error.message}`);
      })
      .finally(() => {
        this.busy = false;
      });
  }
}
