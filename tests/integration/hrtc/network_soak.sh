#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_soak.sh: one controller lives through CYCLES ($7) of: another one that comes and is killed
# or ended, and a link that is cut and mended; and as many of: its host killed and started again.
# The host of the first half and the controller keep within what they had, and no answer was wrong.
source "$(dirname "$0")/two_networks.sh"
readonly cycles=$7
# What a program may have more than after its first cycle, when all that is made once has been made:
# the C library gives memory back late, Cyclone adds receive buffers of 1 MiB each, and keeps 0.8 KB
# of each subscription that a host has served (docs/protocol.md, "Limits").
declare -rA slack_kib=([host]=$((512 + 32 * cycles)) [controller]=$((1024 + 32 * cycles)))

open_files() { find "/proc/$1/fd" -mindepth 1 | wc -l; }

# check_holdings NAME ID CYCLE: of a process; remembers those of cycle 1.
declare -A first_kib first_files
check_holdings() {
    local name=$1 kib files
    kib=$(resident_kib "$2")
    files=$(open_files "$2")
    echo "cycle $3: $name has $kib KiB and $files files"
    if (($3 <= 1)); then
        first_kib[$name]=$kib
        first_files[$name]=$files
    fi
    [[ -n "$sanitizer" ]] || ((kib <= first_kib[$name] + slack_kib[$name])) \
        || fault "$name grew from ${first_kib[$name]} to $kib KiB in $3 cycles"
    ((files <= first_files[$name])) || fault "$name had ${first_files[$name]} files and has $files"
}

# guest CYCLE: another controller for a second; every second one is killed.
guest() {
    local guest signal=TERM
    (($1 % 2 == 0)) || signal=KILL
    "${on_controller[@]}" "$hrtc" --allow-no-rt --domain "$domain" --model large \
        --device sim:touch --pool-mib 2 --duration 60 >guest.log 2>&1 &
    guest=$!
    started+=("$guest")
    wait_for_lines $((2 * $1)) ' subscribed' publish.log
    wait_for_frames 300 publish.log "hrtc-$guest"
    stop "$signal" "$guest"
    wait_for_lines $((2 * $1 - 1)) ' left (' publish.log
}

start_relay --delay-ms 2 --loss 0.005 --duplicates 0.005 --seed 11
model bumpy-sphere-100000 large.spm
start_publisher large.spm --watch
start_hrtc --model large --device sim:touch --pool-mib 2 --no-static --duration 3600 \
    --record run.rec --report report.json
wait_for_lines 1 ' subscribed' publish.log

served=0
for ((cycle = 1; cycle <= cycles; ++cycle)); do
    guest "$cycle"
    relay_say cut
    wait_for_lines "$cycle" 'is gone' hrtc.log
    wait_for_lines $((2 * cycle)) ' left (' publish.log
    relay_say mend
    served=$((served + 1))
    wait_for_lines "$served" 'is served again' hrtc.log
    wait_for_lines $((2 * cycle + 1)) ' subscribed' publish.log
    sleep 0.3 # What the two have to say to each other is said: memory is at rest.
    check_holdings host "$publisher" "$cycle"
    check_holdings controller "$controller" "$cycle"
done
for ((cycle = 1; cycle <= cycles; ++cycle)); do
    stop KILL "$publisher"
    wait_for_lines $((cycles + cycle)) 'is gone' hrtc.log
    start_publisher large.spm
    served=$((served + 1))
    wait_for_lines "$served" 'is served again' hrtc.log
    wait_for_lines 1 ' subscribed' publish.log
    sleep 0.7 # Likewise, of a new host.
    check_holdings controller "$controller" $((cycles + cycle))
done

code=0
kill -TERM "$controller"
wait "$controller" || code=$?
cat hrtc.log
((code == 0)) || fail "hrtc ended with $code"
(($(lines "model 'large'" hrtc.log) == 4 * cycles)) || fault 'not two lines for each loss'
check report.json models.0.host_connected == 1 models.0.static == 0 safety.begun.host '>' 0
check_wire_run report.json
judge_run large.spm
check_span_contact 0 0.1
stop TERM "$publisher"
((stopped_with == 0)) || fault "spm_publish ended with $stopped_with"
finish
