#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_edits.sh: two controllers carve one model over a link that delays, loses, duplicates and
# reorders frames, and is cut for longer than both sides' leases. Afterwards both, and one that
# joins late, have the surface of the server: the answers of all three are right for the model that
# it saves. A third one without the right requests edits all the time, and changes nothing.
source "$(dirname "$0")/two_networks.sh"
source "$(dirname "$0")/edits.sh"

# start_hand NAME ARGUMENT...: starts a controller, with the keys of that name; its output is in
# NAME.log, its id in ids.
declare -A ids=()
start_hand() {
    local name=$1
    [[ -z "${TACTUS_TEST_SECURED:-}" ]] || controller_security=(--security "$PWD/machines/$name")
    start_hrtc --model bumpy --tool sphere:0.002 --pool-mib 24 --name "$name" --duration 3600 \
        --wait "$patience_s" --record "$name.rec" --report "$name.json" "${@:2}"
    ids[$name]=$controller
    mv hrtc.log "$name.log"
}
# start_carver NAME MOTION SECONDS: starts a controller that carves so long. Its hand is a recorded
# one, which is gone afterwards; without a force the tool removes nothing.
start_carver() {
    "$hrtc" bumpy.spm --virtual-time --tool sphere:0.002 --device sim:touch --motion "$2" \
        --duration "$3" --record "$2.rec" >motion.log 2>&1 || fail "the hand: $(cat motion.log)"
    start_hand "$1" --edit carve:20 --device "replay:$2.rec"
}

# metric NAME: prints the server's sample of that name.
metric() {
    in_server_network python3 - "$metrics" "$1" <<'PYTHON'
import sys
import urllib.request

opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
for line in opener.open(sys.argv[1]).read().decode().splitlines():
    name, _, value = line.rpartition(" ")
    if name.split("{")[0] == sys.argv[2]:
        print(value)
PYTHON
}
edits() { metric tactus_model_edits_total; }
has_edits() { (($(edits) >= $1)); }
wait_for_more_edits() { wait_until "$1 more edits" has_edits $(($(edits) + $1)); }
# has_no_hand: true if the recorded hands of all carvers are gone.
has_no_hand() {
    local name
    for name in "${carvers[@]}"; do
        has_lines 'is disconnected; no force until' "$name.log" 1 || return 1
    done
}
has_edits_or_no_hand() { has_edits "$1" || has_no_hand; }
# is_settled: true if no edit came within a second or more.
is_settled() {
    local before
    before=$(edits)
    wait_for_more_frames 1000 publish.log editor-1
    (($(edits) == before))
}
# stop_hand NAME: ends that controller, and checks its run.
stop_hand() {
    controller=${ids[$1]}
    mv "$1.log" hrtc.log
    stop_hrtc
    mv hrtc.log "$1.log"
    check_clean "$1.json"
    check "$1.json" models.0.edits '>' 0 models.0.edits_refused == 0
}

# carve_across_a_cut SECONDS: hands of that time carve before a cut and after it; false if they were
# gone before enough edits came afterwards.
carve_across_a_cut() {
    local name wanted rights=() # The role of the certificate.
    start_carver editor-1 slide "$1"
    start_carver editor-2 spin "$1"
    start_carver hand-1 tap "$1"
    [[ -n "${TACTUS_TEST_SECURED:-}" ]] \
        || rights=(--edits-from "$(uname -n):${ids[editor-1]}" "$(uname -n):${ids[editor-2]}")
    start_publisher bumpy.spm --edits "${rights[@]}" --edit-room 32768 --watch --metrics 0 \
        --save carved.spm
    metrics=$(sed -n 's/^metrics on //p' publish.log)
    wait_for_line publish.log ' subscribed' 3
    wait_for_more_edits 10

    relay_say cut
    for name in "${carvers[@]}"; do
        wait_for_line "$name.log" \
            "server of model 'bumpy' disconnected; the resident data stay in use"
    done
    wait_for_line publish.log ' left (' 3
    wait_for_more "${ids[editor-1]}" # The participants' lease also ends.
    relay_say restore
    for name in "${carvers[@]}"; do
        wait_for_line "$name.log" "model 'bumpy' is served again by the same server"
    done
    wait_for_line publish.log ' subscribed' 6
    wanted=$(($(edits) + 10))
    wait_until '10 more edits' has_edits_or_no_hand "$wanted"
    has_edits "$wanted"
}

start_relay --delay-ms 5 --jitter-ms 2 --loss 0.01 --duplicates 0.01 --seed 11
model bumpy-sphere-20000 bumpy.spm
carvers=(editor-1 editor-2 hand-1)
if ! carve_across_a_cut 60; then
    echo 'held up by the machine: the hands were gone before the cut had healed'
    for name in "${carvers[@]}"; do stop TERM "${ids[$name]}"; done
    stop_publisher
    carve_across_a_cut 150 || fault 'hands that carve after the cut as well'
fi

for name in "${carvers[@]}"; do
    wait_for_line "$name.log" 'is disconnected; no force until'
done
wait_until 'end of the edits' is_settled
start_hand hand-2 --device sim:touch --motion slide
for name in "${carvers[@]}" hand-2; do wait_for_more_frames 3000 publish.log "$name"; done
for name in "${carvers[@]}" hand-2; do stop_hand "$name"; done
stop_publisher
cat publish.log

check editor-1.json carving.sent '>' 0
check editor-2.json carving.sent '>' 0
if [[ -n "${TACTUS_TEST_SECURED:-}" ]]; then
    check hand-1.json carving.sent == 0 carving.unsent '>' 0
    (($(lines "edit requests can't be sent: " hand-1.log) == 1)) || fault 'no line tells the right'
else
    check hand-1.json carving.sent '>' 0
    grep -Eq ' accepted, [1-9][0-9]* refused' publish.log || fault 'an editor without the right'
fi
check_saved "$inspect"
added=$(of_edits ' \([0-9]*\) of [0-9]* added faces')
for name in "${carvers[@]}" hand-2; do check "$name.json" models.0.added_faces == "$added"; done
for name in editor-1 editor-2 hand-2; do
    frames=$(sed -n 's/^recording *\([0-9]*\) frames.*/\1/p' "$name.log")
    "$judge_recording" "$name.rec" carved.spm $((frames - 1000)) >judged.json 2>judged.log \
        || fail "the recording of $name does not replay"
    check judged.json frames == "$frames" spans.1.frames == 1000 spans.1.violations == 0
done
finish
