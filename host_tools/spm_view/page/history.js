// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The states of a minute, by their times.
export class History {
  constructor(longest_s = 60) {
    this.longest_s = longest_s;
    this.entries = [];
  }

  /// What is later is forgotten: a recording may be played again.
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

  /// The last one that had come by then, or the oldest; null when there is none.
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
