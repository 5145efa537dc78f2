// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// States of the last minute, ascending by time.
export class History {
  constructor(longest_s = 60) {
    this.longest_s = longest_s;
    this.entries = [];
  }

  /// Adds a state and removes those at the same or later times, since a recording may be played
  /// again.
  add(state, at_s) {
    while (this.entries.length > 0 && this.entries[this.entries.length - 1].at_s >= at_s) {
      this.entries.pop();
    }
    this.entries.push({ state, at_s });
    const oldest_s = at_s - this.longest_s;
    let gone = 0;
    while (this.entries[gone].at_s < oldest_s) {
      ++gone;
    }
    this.entries.splice(0, gone);
  }

  clear() {
    this.entries = [];
  }

  /// Newest state not after `time_s`; the oldest state if all are after; null if there is none.
  at(time_s) {
    let found = null;
    for (const entry of this.entries) {
      if (found !== null && entry.at_s > time_s) {
        break;
      }
      found = entry;
    }
    return found;
  }
}
