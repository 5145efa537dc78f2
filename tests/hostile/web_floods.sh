#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# web_floods.sh BIN CHECK_REPORT SANITIZER: pages and metrics while other programs of this machine
# request hundreds of parts together, or keep the servers of spm_view and spm_publish --metrics
# waiting.
here=$(cd "$(dirname "$0")" && pwd)
readonly here
source "$here/../integration/hrtc/common.sh"
readonly view=$1/spm_view
command -v curl >/dev/null || exit 77
model torus-20000 torus.spm

attack() { python3 "$here/web_peers.py" "$@"; }
get() { curl --silent --fail --max-time "$patience_s" "$1"; }

start_publisher torus.spm --metrics 0
served=$(sed -n 's/^metrics on //p' publish.log)
"$view" --domain "$domain" --port 0 >view.log 2>&1 &
viewer=$!
started+=("$viewer")
wait_for_line view.log ' shows '
page=$(sed -n 's|^\(http://[^ ]*\)/ .*|\1|p' view.log)

# Parts: each answer is the whole, once. They were 368 MiB for one request.
library=$page/lib/three.min.js
size=$(get "$library" | wc -c)
before=$(memory_kib "$viewer")
read -r -a sizes < <(attack "$library" parts)
after=$(memory_kib "$viewer")
((${#sizes[@]} == 4)) || fault "${#sizes[@]} answers"
for one in "${sizes[@]}"; do
    ((one > size && one < size + 2000)) || fault "an answer of $one bytes to $size"
done
echo "the viewer's memory: $before KiB before, $after KiB after four requests for 300 parts"
[[ -n "$sanitizer" ]] || ((after < before + 16 * 1024)) || fault "it took $((after - before)) KiB"

# Forty slow requests, repeatedly: others are answered meanwhile.
for url in "$served" "$page/state" "$page/metrics"; do
    coproc slow { attack "$url" slow; }
    attacking=$!
    started+=("$attacking")
    read -r word <&"${slow[0]}"
    [[ "$word" == ready ]] || fault "the attacker: $word"
    for _ in 1 2 3 4 5; do
        get "$url" >answer.txt || fault "$url: no answer while forty are slow ($?)"
        [[ -s answer.txt ]] || fault "$url: an empty answer"
    done
    eval "exec ${slow[1]}>&-"
    wait "$attacking" || fault "the attacker ended with $?"
done
for id in "$publisher" "$viewer"; do
    kib=$(memory_kib "$id")
    [[ -n "$sanitizer" ]] || ((kib < 100 * 1024)) || fault "process $id took $kib KiB"
done
stop TERM "$viewer"
((stopped_with == 0)) || fault "spm_view ended with $stopped_with"
stop_publisher
finish
