#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# holes_and_handles.sh SPM_BUILD SPM_INSPECT: a scan with pinholes, a sheet with many holes and
# chain mail become models with a small base, which spm_inspect finds sound: every face is present,
# closed surfaces stay closed, and no bound is wrong in the tested cuts.
set -euo pipefail
readonly build=$1 inspect=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
failures=0

# check NAME FACES CLOSED BASE NOTE: expects the faces of NAME.obj, and the note.
check() {
    local base
    "$build" "$1.obj" -o "$1.spm" --json >built.json 2>told || { cat told; exit 1; }
    "$inspect" "$1.spm" --json >seen.json 2>>told || failures=$((failures + 1))
    base=$(sed -E 's/.*"base_faces":([0-9]+).*/\1/' built.json)
    if ((base > $4)) || ! grep -q "\"faces\": *$2[,}]" built.json \
        || ! grep -q "\"is_closed\": *$3" seen.json || [[ $(<told) != *"$5"* ]]; then
        printf '%s: expected %s faces, closed: %s, a base of %s at most and "%s"; got\n' "$@"
        cat built.json seen.json told
        failures=$((failures + 1))
    fi
}

# 120 x 120 squares with a face missing in each ninth: 1,600 holes of three edges.
awk 'BEGIN {
    for (y = 0; y <= 120; ++y) for (x = 0; x <= 120; ++x)
        print "v", x / 1000, y / 1000, sin(x / 9) * cos(y / 7) / 300
    for (y = 0; y < 120; ++y) for (x = 0; x < 120; ++x) {
        a = y * 121 + x + 1
        if (x % 3 != 1 || y % 3 != 1 || x % 2) print "f", a, a + 1, a + 122
        if (x % 3 != 1 || y % 3 != 1 || x % 2 == 0) print "f", a, a + 122, a + 121
    }
}' >scan.obj
check scan 27200 false 500 ''

# Closed sheet with 24 x 24 square holes: 576 handles, so a base of at least 2,306 faces.
awk 'function side(a, b, c, d) { print "f", a, b, c; print "f", a, c, d }
function at(x, y, z) { return (y * (n + 1) + x) * 2 + z + 1 }
function solid(x, y) { return x >= 0 && y >= 0 && x < n && y < n && (x % 2 == 0 || y % 2 == 0) }
BEGIN {
    n = 49
    for (y = 0; y <= n; ++y) for (x = 0; x <= n; ++x) {
        print "v", x / 1000, y / 1000, 0
        print "v", x / 1000, y / 1000, 0.001
    }
    for (y = 0; y < n; ++y) for (x = 0; x < n; ++x) if (solid(x, y)) {
        side(at(x, y, 1), at(x + 1, y, 1), at(x + 1, y + 1, 1), at(x, y + 1, 1))
        side(at(x, y, 0), at(x, y + 1, 0), at(x + 1, y + 1, 0), at(x + 1, y, 0))
        if (!solid(x, y - 1)) side(at(x, y, 0), at(x + 1, y, 0), at(x + 1, y, 1), at(x, y, 1))
        if (!solid(x + 1, y))
            side(at(x + 1, y, 0), at(x + 1, y + 1, 0), at(x + 1, y + 1, 1), at(x + 1, y, 1))
        if (!solid(x, y + 1))
            side(at(x + 1, y + 1, 0), at(x, y + 1, 0), at(x, y + 1, 1), at(x + 1, y + 1, 1))
        if (!solid(x - 1, y)) side(at(x, y + 1, 0), at(x, y, 0), at(x, y, 1), at(x, y + 1, 1))
    }
}' >sheet.obj
check sheet "$(grep -c '^f' sheet.obj)" true 2000 'handles cut open without a gap, with'

# 200 rings in rows; each keeps at least 14 faces while it is a ring.
awk 'BEGIN {
    pi = atan2(0, -1)
    for (k = 0; k < 200; ++k) {
        for (a = 0; a < 12; ++a) for (c = 0; c < 6; ++c) {
            u = 2 * pi * a / 12; w = 2 * pi * c / 6; r = 4 + cos(w)
            print "v", (11 * (k % 20) + r * cos(u)) / 1000, (11 * int(k / 20) + r * sin(u)) / 1000,
                sin(w) / 1000
        }
        for (a = 0; a < 12; ++a) for (c = 0; c < 6; ++c) {
            p = 72 * k + a * 6 + c + 1; q = 72 * k + (a + 1) % 12 * 6 + c + 1
            r = 72 * k + (a + 1) % 12 * 6 + (c + 1) % 6 + 1; s = 72 * k + a * 6 + (c + 1) % 6 + 1
            print "f", p, q, r; print "f", p, r, s
        }
    }
}' >mail.obj
check mail 28800 true 2000 '200 handles cut open'
((failures == 0))
