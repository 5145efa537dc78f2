#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# c_interface.sh SPM_BUILD ASK: a program in C asks this build's library about the ring of
# project/serve.cpp.
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
awk 'BEGIN {
    for (i = 0; i < 64; ++i)
        for (k = 0; k < 32; ++k) {
            along = atan2(0, -1) * i / 32
            across = atan2(0, -1) * k / 16
            thick = 0.012 + 0.001 * sin(5 * along + across)
            out = 0.028 + thick * cos(across)
            printf "v %.17g %.17g %.17g\n", out * cos(along), out * sin(along), thick * sin(across)
        }
    for (i = 0; i < 64; ++i)
        for (k = 0; k < 32; ++k) {
            a = 1 + i * 32
            b = 1 + (i + 1) % 64 * 32
            next_k = (k + 1) % 32
            print "f", a + k, b + k, b + next_k
            print "f", a + k, b + next_k, a + next_k
        }
}' >ring.obj
"$1" ring.obj --unit m -o ring.spm >build.log || { cat build.log; exit 1; }
"$2" ring.spm
