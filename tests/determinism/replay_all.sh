#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# replay_all.sh REPLAYER RECORDINGS ALTER ALTERED [EMULATOR]: replays all recordings with the best
# and, in parallel, with the portable kernels. A recording that ALTER changed in one frame, written
# to the file ALTERED, must be reported with that frame.
set -euo pipefail
readonly replayer=$1 recordings=$2 alter=$3 altered=$4 emulator=${5:-}

replay() { ${emulator:+"$emulator"} "$replayer" "$@"; }
replay best "$recordings"/*.rec &
best=$!
if [[ -z "$emulator" ]]; then # An emulated processor is another one, whose best kernels these are.
    replay portable "$recordings"/*.rec
fi
wait "$best"

"$alter" "$recordings/smooth.rec" "$altered" 300
code=0
said=$(replay best "$altered") || code=$?
if ((code != 1)) || [[ "$said" != *"frame 300 differs: "* ]]; then
    printf 'an altered recording was not told, exit %d:\n%s\n' "$code" "$said"
    exit 1
fi
