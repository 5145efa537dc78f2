#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_soak.sh: one controller runs through CYCLES ($7) of another controller that starts and is
# killed or ended, and of a link that is cut and restored; and as many of a killed and restarted
# server. The server of the first half and the controller keep their resources, and no answer was
# wrong.
source "$(dirname "$0")/two_networks.sh"
readonly cycles=$7
# Permitted growth after the first cycle: the C library returns memory late, Cyclone adds receive
# buffers of 1 MiB each, and keeps 0.8 KB of each subscription that a server has served
# (docs/protocol.md, "Limits").
declare -rA slack_kib=([server]=$((512 + 32 * cycles)) [controller]=$((1024 + 32 * cycles)))

open_files() { find "/proc/$1/fd" -mindepth 1 | wc -l; }

# check_holdings NAME ID CYCLE: a process returns to its resources after cycle 1, which are stored.
declare -A first_kib first_files
check_holdings() {
    local name=$1
    if (($3 == 1)); then
        wait_until "rest of $name's memory" is_at_rest "$2"
        first_kib[$name]=$(resident_kib "$2")
        first_files[$name]=$(open_files "$2")
    fi
    wait_until "end of $name's growth, ${first_kib[$name]} KiB and ${first_files[$name]} files" \
        has_no_more "$name" "$2"
    echo "cycle $3: $name has $(resident_kib "$2") KiB and $(open_files "$2") files"
}
is_at_rest() {
    local before
    before=$(resident_kib "$1")
    sleep 0.3
    [[ $(resident_kib "$1") == "$before" ]]
}
has_no_more() {
    { [[ -n "$sanitizer" ]] || (($(resident_kib "$2") <= first_kib[$1] + slack_kib[$1])); } \
        && (($(open_files "$2") <= first_files[$1]))
}

# short_controller CYCLE: another controller for a second; every second one is killed.
short_controller() {
    local controller signal=TERM
    (($1 % 2 == 0)) || signal=KILL
    "${on_controller[@]}" "$hrtc" --allow-no-rt --domain "$domain" \
        "${controller_security[@]}" --model large \
        --device sim:touch --pool-mib 2 --duration 60 >controller.log 2>&1 &
    controller=$!
    started+=("$controller")
    wait_for_line publish.log ' subscribed' $((2 * $1))
    wait_for_frames 300 publish.log "hrtc-$controller"
    stop "$signal" "$controller"
    wait_for_line publish.log ' left (' $((2 * $1 - 1))
}

start_relay --delay-ms 2 --loss 0.005 --duplicates 0.005 --seed 11
model bumpy-sphere-100000 large.spm
start_publisher large.spm --watch
start_hrtc --model large --device sim:touch --pool-mib 2 --no-static --duration 3600 \
    --failover any \
    --record run.rec --report report.json
wait_for_line publish.log ' subscribed'

served=0
for ((cycle = 1; cycle <= cycles; ++cycle)); do
    short_controller "$cycle"
    relay_say cut
    wait_for_line hrtc.log 'disconnected' "$cycle"
    wait_for_line publish.log ' left (' $((2 * cycle))
    relay_say restore
    served=$((served + 1))
    wait_for_line hrtc.log 'is served again' "$served"
    wait_for_line publish.log ' subscribed' $((2 * cycle + 1))
    check_holdings server "$publisher" "$cycle"
    check_holdings controller "$controller" "$cycle"
done
for ((cycle = 1; cycle <= cycles; ++cycle)); do
    stop KILL "$publisher"
    wait_for_line hrtc.log 'disconnected' $((cycles + cycle))
    start_publisher large.spm
    served=$((served + 1))
    wait_for_line hrtc.log 'is served again' "$served"
    wait_for_line publish.log ' subscribed'
    check_holdings controller "$controller" $((cycles + cycle))
done

stop_hrtc
(($(lines_of_server large hrtc.log) == 5 * cycles)) \
    || fault 'not two lines for each loss, and one for each server that is followed'
check report.json models.0.server_connected == 1 models.0.static == 0 safety.begun.server '>' 0
check_wire_run report.json
judge_run large.spm
check_span_contact 0 0.1
stop_publisher
finish
