// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

const TICK_MS = 40;
/// Number of states, over the last minute, that are fetched for the plots after a jump.
const MOMENTS = 120;

/// Plays recordings: has the present frame and the speed. One frame is requested at a time, so a
/// slow machine skips frames.
export class Player {
  /// Calls `take(states, is_leap, fault)` with the states up to the present frame; after a jump
  /// (`is_leap`) those of the last minute.
  constructor(film, take) {
    this.film = film;
    this.take = take;
    this.place = 0; // Number of the frame, plus the elapsed part of the frame.
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
  /// Jumps to a frame; the plots are filled again.
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
