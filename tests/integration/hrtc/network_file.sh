#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_file.sh: the file is cut, written over, or replaced by another one while it is touched. Of
# the first two the host names what it can't serve any more; one that takes the name of a file in
# use leaves that as it is. No answer is wrong, and the host goes on.
source "$(dirname "$0")/two_networks.sh"

start_relay --delay-ms 2
model bumpy-sphere-200000 large.spm
model bumpy-sphere-190000 other.spm
readonly changed_at=2500 # The frame after which the file is certainly another one.

# touch_while COMMAND...: hrtc on served.spm, a fresh copy of large.spm, to which the command is
# done after one to two seconds.
touch_while() {
    local code=0
    rm -f served.spm
    cp large.spm served.spm
    start_publisher served.spm --watch
    start_hrtc --model served --device sim:touch --pool-mib 2 --no-static --duration 6 \
        --record run.rec --report report.json
    wait_for_frames 1000 publish.log
    "$@"
    wait "$controller" || code=$?
    cat hrtc.log publish.log
    ((code == 0)) || fail "hrtc ended with $code"
    [[ $(grep "model 'served'" hrtc.log | grep -cv "doesn't come; \|has come after all") == 0 ]] \
        || fault 'a line about the host, which was there'
    check report.json frames == 6000 wire.host_lost == 0 safety.begun.host == 0 \
        models.0.host_connected == 1
    check_wire_run report.json
    judge_run large.spm "$changed_at"
    stop TERM "$publisher"
    ((stopped_with == 0)) || fault "spm_publish ended with $stopped_with"
}
cut_to_a_third() { truncate -s $(($(stat -c %s large.spm) / 3)) served.spm; }
write_over() { cat other.spm >served.spm; }
replace() {
    cp other.spm new.spm
    mv new.spm served.spm
}

# What the host can't serve is told by the controller, too.
missing_is_told() {
    grep -q "model 'served': chunk [0-9]* doesn't come; the surface there stays coarse" hrtc.log \
        || fault 'no missing chunk is named'
    check report.json models.0.pieces_missing '>' 0
}

touch_while cut_to_a_third
missing_is_told
grep -q 'served.spm: chunk [0-9]* at offset ' publish.log || fault 'no chunk is named as cut off'

touch_while write_over
missing_is_told
grep -q 'served.spm: .* at offset [0-9]* is damaged' publish.log || fault 'no damage is named'

touch_while replace
[[ $(lines 'served.spm: ' publish.log) == 0 ]] || fault 'damage of a file that is another one'
check report.json models.0.pieces_missing == 0
check_contact report.json force.contact_share 0.3
check_span_contact 1 0.1
check report.json answers.exact+answers.decided '>' '0.9*frames'
finish
