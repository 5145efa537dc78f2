#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_file.sh: the file is truncated, overwritten, or replaced by another one while it is
# touched. For the first two the server names the unavailable data; a file with the name of one in
# use leaves that unchanged. No answer is wrong, and the server continues.
source "$(dirname "$0")/two_networks.sh"

start_relay --delay-ms 2
model bumpy-sphere-200000 large.spm
model bumpy-sphere-100000 other.spm

# touch_while COMMAND...: runs hrtc on served.spm, a copy of large.spm, and the command during the
# touch. $changed_at is a frame after it.
touch_while() {
    rm -f served.spm
    cp large.spm served.spm
    start_publisher served.spm --watch
    start_hrtc --model served --device sim:touch --pool-mib 2 --no-static --duration 600 \
        --record run.rec --report report.json
    wait_for_contact publish.log
    "$@"
    wait_for_frames $(($(frames_in publish.log) + 1)) publish.log
    changed_at=$(frames_in publish.log)
    wait_for_frames $((changed_at + 500)) publish.log
}
# end_touch: ends everything, with the server present throughout.
end_touch() {
    stop_hrtc
    cat publish.log
    [[ $(grep "model 'served'" hrtc.log | grep -cv "has not arrived; \|has arrived late") == 0 ]] \
        || fault 'a line about the server, which was there'
    check report.json frames '>' $((changed_at + 500)) wire.server_lost == 0 \
        safety.begun.server == 0 models.0.server_connected == 1
    check_wire_run report.json
    judge_run large.spm "$changed_at"
    stop_publisher
}
cut_to_a_third() { truncate -s $(($(stat -c %s large.spm) / 3)) served.spm; }
write_over() { cat other.spm >served.spm; }
replace() {
    cp other.spm new.spm
    mv new.spm served.spm
}

# fail_to_serve PATTERN COMMAND...: server and controller name the data that cannot be served.
fail_to_serve() {
    touch_while "${@:2}"
    wait_until 'word of the server' grep -q "$1" publish.log
    wait_until 'missing chunk' \
        grep -q "model 'served': chunk [0-9]* has not arrived; the surface there stays" hrtc.log
    end_touch
    check report.json models.0.pieces_missing '>' 0
}
fail_to_serve 'served.spm: chunk [0-9]* at offset ' cut_to_a_third
fail_to_serve 'served.spm: .* at offset [0-9]* is damaged' write_over

touch_while replace
end_touch
[[ $(lines 'served.spm: ' publish.log) == 0 ]] || fault 'damage of a file that is another one'
check report.json models.0.pieces_missing == 0
check_contact report.json force.contact_share 0.3
check_span_contact 1 0.1
check report.json answers.exact+answers.separated+answers.within_tolerance '>' '0.9*frames'
finish
