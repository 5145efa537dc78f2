#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# sniffed.sh BIN CHECK_REPORT SANITIZER SNIFF: in a network of its own, what can be read of a run:
# without keys the model's name and pieces, with keys neither.
if [[ -z "${TACTUS_SNIFFED:-}" ]]; then
    if ((EUID != 0)) || ! unshare --net true 2>/dev/null || ! command -v python3 >/dev/null; then
        echo 'skipped: only root may listen to packets, and python3 does'
        exit 77
    fi
    TACTUS_SNIFFED=1 exec unshare --net bash "$0" "$@"
fi
source "$(dirname "$0")/../integration/hrtc/common.sh"
readonly sniff=$4 name=name-of-a-model
ip link set lo up || fail 'no loopback'
model bumpy-sphere-20000 bumpy.spm

# sniff_run FILE: a run of two seconds, from before the server starts to its end.
sniff_run() {
    python3 "$sniff" bumpy.spm "$name" >sniffed.log 2>&1 &
    local sniffer=$!
    started+=("$sniffer")
    wait_for_line sniffed.log ready
    start_publisher bumpy.spm --name "$name"
    contact=0 run_hrtc --model "$name" --device sim:touch --duration 2
    stop_publisher
    kill -TERM "$sniffer"
    wait "$sniffer" || fault "$(cat sniffed.log)"
    sed 1d sniffed.log >"$1"
    cat "$1"
}
sniff_run plain.json
check plain.json udp '>' 100 words '>' 0 payload '>' 0
use_keys
sniff_run secured.json
check secured.json udp '>' 100 words == 0 payload == 0
finish
