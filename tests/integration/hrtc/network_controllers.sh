#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_controllers.sh: controllers are killed and started again 10 ms from their server. It
# counts each and does not grow, another controller is not affected, and the touch of the last one
# started is as good as any.
source "$(dirname "$0")/two_networks.sh"
readonly kills=3

# start_controller NAME ARGUMENT...: its output is in NAME.log, its id in $controller.
start_controller() {
    "${on_controller[@]}" "$hrtc" --allow-no-rt --domain "$domain" \
        "${controller_security[@]}" --model large \
        --device sim:touch --pool-mib 2 --duration 600 --name "$@" >"$1.log" 2>&1 &
    controller=$!
    started+=("$controller")
}

start_relay --delay-ms 10
model bumpy-sphere-100000 large.spm
start_publisher large.spm --watch
start_controller steady --record run.rec --report steady.json
steady=$controller
wait_for_line publish.log ' subscribed'

for ((kill = 1; kill <= kills; ++kill)); do
    start_controller "killed-$kill"
    wait_for_line publish.log ' subscribed' $((1 + kill))
    wait_for_frames 300 publish.log "killed-$kill"
    stop KILL "$controller"
    wait_for_line publish.log ' left (' "$kill"
    ((kill > 1)) || first_kib=$(resident_kib "$publisher") # The first two are served.
done
last_kib=$(resident_kib "$publisher")
echo "the server has $first_kib, later $last_kib KiB"
[[ -n "$sanitizer" ]] || ((last_kib - first_kib <= 1024)) || fault 'the server grows with each kill'

controller=$steady
mv steady.log hrtc.log
stop_hrtc
(($(lines_of_server large hrtc.log) == 0)) || fault 'it was told of a server that went'
check steady.json frames '>' 1000 wire.server_lost == 0 safety.begun.server == 0 \
    answers.exact+answers.separated+answers.within_tolerance '>' '0.9*frames'
check_wire_run steady.json
check_contact steady.json force.contact_share 0.3
judge_run large.spm

run_hrtc --model large --device sim:touch --pool-mib 2 --duration 2 --record run.rec
check report.json frames == 2000 wire.server_lost == 0 safety.begun.server == 0 \
    answers.exact+answers.separated+answers.within_tolerance '>' '0.9*frames'
check_wire_run report.json
check_contact report.json force.contact_share 0.3
judge_run large.spm
stop_publisher
finish
