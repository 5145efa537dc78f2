#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_restart.sh: hosts are killed and started again 10 ms away. The same file is used again and
# nothing of it is loaded twice; another file of that name is kept apart, and is what the next
# controller takes. Of a model that is here as a whole the touch goes on.
source "$(dirname "$0")/two_networks.sh"

start_relay --delay-ms 10
model bumpy-sphere-200000 large.spm
model bumpy-sphere-190000 other.spm

start_publisher large.spm --watch
start_hrtc --model large --device sim:touch --pool-mib 8 --no-static --duration 10 \
    --record run.rec --report report.json
wait_for_frames 1500 publish.log
killed_ms=$(now_ms)
stop KILL "$publisher"
wait_for_line hrtc.log "host of model 'large' is gone; going on with what is resident" 5
check_notice hrtc.log "$killed_ms"

start_publisher large.spm --watch
wait_for_line hrtc.log 'is served again, by another host or a restarted one with the same file' 5
wait_for_line publish.log ' subscribed' 5
wait_for_frames 5500 publish.log
stop KILL "$publisher"
for ((i = 0; i < 100; ++i)); do
    (($(lines 'is gone' hrtc.log) < 2)) || break
    sleep 0.05
done

start_publisher other.spm --name large
wait_for_line hrtc.log "model 'large' is now published with another hash" 5
code=0
wait "$controller" || code=$?
cat hrtc.log publish.log
((code == 0)) || fail "hrtc ended with $code"
[[ $(lines "model 'large'" hrtc.log) == 4 && $(lines 'is gone' hrtc.log) == 2 \
    && $(lines 'served again' hrtc.log) == 1 && $(lines 'another hash' hrtc.log) == 1 ]] \
    || fault 'not one line for each host that goes, for the one that is back, and for the other'
[[ $(lines ' subscribed' publish.log) == 0 ]] || fault 'the other file was asked for'

check report.json frames == 10000 wire.host_lost == 1 models.0.host_connected == 0 \
    safety.begun.host == 2 models.0.static == 0 cache.evictions == 0 \
    pools.pages.used_max+pools.index_pages.used_max == '1*cache.loads'
check_wire_run report.json
judge_run large.spm
# Against another mesh the same answers are wrong.
"$judge_recording" run.rec other.spm >judged.json 2>/dev/null || fail 'it does not replay'
check judged.json violations '>' 0

# A controller that starts now takes the file that is there now.
run_hrtc --model large --device sim:touch --pool-mib 2 --duration 3 --record run.rec
check report.json wire.host_lost == 0 safety.begun.host == 0
check_wire_run report.json
check_contact report.json force.contact_share 0.3
judge_run other.spm
stop TERM "$publisher"

model bumpy-sphere-5000 small.spm
start_publisher small.spm --watch
start_hrtc --model small --device sim:touch --duration 5 --record run.rec --report report.json
wait_for_frames 1000 publish.log
stop KILL "$publisher"
wait_for_line hrtc.log "host of model 'small' is gone" 5
readonly near_the_kill=2500 # Frames; the run's last half, at least, is without a host.
code=0
wait "$controller" || code=$?
cat hrtc.log
((code == 0)) || fail "hrtc ended with $code"
check report.json frames == 5000 wire.host_lost == 1 safety.begun.host == 0 models.0.static == 1
check_wire_run report.json
judge_run small.spm "$near_the_kill"
check_span_contact 1 0.3
finish
