#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_restart.sh: servers are killed and started again 10 ms away. The same file is used again
# and nothing of it is loaded twice; another file of that name is kept apart, and is taken by the
# next controller. The touch of a fully resident model continues.
source "$(dirname "$0")/two_networks.sh"

start_relay --delay-ms 10
model bumpy-sphere-200000 large.spm
model bumpy-sphere-100000 other.spm

start_publisher large.spm --watch
start_hrtc --model large --device sim:touch --pool-mib 8 --no-static --duration 600 \
    --record run.rec --report report.json
wait_for_contact publish.log
stop KILL "$publisher"
wait_for_line hrtc.log "server of model 'large' disconnected; the resident data stay in use"

start_publisher large.spm --watch
wait_for_line hrtc.log 'is served again, by another server or a restarted one with the same file'
wait_for_line publish.log ' subscribed'
wait_for_more_frames 500 publish.log
stop KILL "$publisher"
wait_for_line hrtc.log 'disconnected' 2

start_publisher other.spm --name large
wait_for_line hrtc.log "model 'large' is now published with another hash"
stop_hrtc
cat publish.log
[[ $(lines_of_server large hrtc.log) == 5 && $(lines 'disconnected' hrtc.log) == 2 \
    && $(lines 'served again' hrtc.log) == 1 && $(lines 'another hash' hrtc.log) == 1 ]] \
    || fault 'not a line for each server that goes, two for the one that is back, one for the other'
[[ $(lines ' subscribed' publish.log) == 0 ]] || fault 'the other file was asked for'

check report.json frames '>' 1500 wire.server_lost == 1 models.0.server_connected == 0 \
    safety.begun.server == 2 models.0.static == 0 cache.evictions == 0 \
    pools.pages.used_max+pools.index_pages.used_max == '1*cache.loads'
check_wire_run report.json
judge_run large.spm
# The same answers are wrong for another mesh.
"$judge_recording" run.rec other.spm >judged.json 2>/dev/null || fail 'it does not replay'
check judged.json violations '>' 0

# A controller that starts now takes the present file.
run_hrtc --model large --device sim:touch --pool-mib 2 --duration 2 --record run.rec
check report.json wire.server_lost == 0 safety.begun.server == 0
check_wire_run report.json
check_contact report.json force.contact_share 0.3
judge_run other.spm
stop_publisher

model bumpy-sphere-5000 small.spm
start_publisher small.spm --watch
start_hrtc --model small --device sim:touch --duration 600 --record run.rec --report report.json
wait_for_contact publish.log
stop KILL "$publisher"
wait_for_line hrtc.log "server of model 'small' disconnected"
wait_for_more "$controller"
stop_hrtc
check report.json frames '>' 1000 wire.server_lost == 1 safety.begun.server == 0 \
    models.0.static == 1
check_wire_run report.json
judge_run small.spm $(($(recorded_frames) - 500)) # The rest is without a server.
check_span_contact 1 0.3
finish
