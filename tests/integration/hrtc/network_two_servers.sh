#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_two_servers.sh: two servers offer different files under one name. A controller stays with
# the one that it discovered first or was pinned to, and is notified of the other; nothing is mixed.
source "$(dirname "$0")/two_networks.sh"

start_relay --delay-ms 10
model bumpy-sphere-100000 first.spm
model bumpy-sphere-60000 second.spm

# check_touch FILE: the run of hrtc.log and run.rec touched this file, without pieces of others.
check_touch() {
    check report.json wire.server_lost == 0 safety.begun.server == 0 models.0.server_connected == 1
    check_wire_run report.json
    check_contact report.json force.contact_share 0.3
    judge_run "$1"
}
subscriptions() { lines ' subscribed' "$1"; }
touch_sphere() { run_hrtc --device sim:touch --pool-mib 2 --duration 2 --record run.rec "$@"; }

start_publisher first.spm --name ball --watch
first=$publisher
start_hrtc --model ball --device sim:touch --pool-mib 2 --duration 600 --record run.rec \
    --report report.json
wait_for_contact publish.log
mv publish.log first.log # The server continues to write there.
start_publisher second.spm --name ball
mv publish.log second.log
wait_for_line hrtc.log "warning: model 'ball' is offered by a second server, spm_publish"
wait_for_more_frames 500 first.log
stop_hrtc
(($(lines_of_server ball hrtc.log) == 1)) || fault 'not one line about the second server'
[[ $(subscriptions second.log) == 0 ]] || fault 'the second server was asked'
check_touch first.spm
"$judge_recording" run.rec second.spm >judged.json 2>/dev/null || fail 'it does not replay'
check judged.json violations '>' 0 # The two are distinguishable.

for which in first second; do
    before=$(subscriptions $which.log)
    hash=$(sed -n "s/^serving 'ball' hash \([0-9a-f]*\):.*/\1/p" $which.log)
    touch_sphere --model "ball@$hash"
    (($(subscriptions $which.log) > before)) || fault "pinned to the $which, but it was not asked"
    check_touch $which.spm
done

# Either of the two without a pin, but only one; the warning names it.
touch_sphere --model ball
other=$(sed -n "s/.*a second server, .*, with another hash, \([0-9a-f]*\); .*/\1/p" hrtc.log)
which=first
! grep -qF "hash $other:" first.log || which=second
[[ -n "$other" ]] || fault 'no warning of two hashes'
check_touch $which.spm
stop_publisher
stop TERM "$first"
((stopped_with == 0)) || fault "the first server ended with $stopped_with"
finish
