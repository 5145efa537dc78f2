#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_cut.sh: the link is cut for two seconds in mid-run. Both sides notice; the force of a
# model that is here in part fades and comes back with the link, that of one that is here as a whole
# stays.
source "$(dirname "$0")/two_networks.sh"

# cut_in_mid_run MODEL ARGUMENT...: hrtc on that model with a cut from about 2 to 4 s.
cut_in_mid_run() {
    local code=0 model=$1 cut_ms
    shift
    start_publisher "$model.spm" --watch
    start_hrtc --model "$model" --device sim:touch --duration 8 --record run.rec \
        --report report.json "$@"
    wait_for_frames 1500 publish.log
    relay_say cut
    cut_ms=$(now_ms)
    wait_for_line hrtc.log "host of model '$model' is gone; going on with what is resident" 5
    check_notice hrtc.log "$cut_ms"
    wait_for_line publish.log ' left (' 5
    while (($(now_ms) < cut_ms + 2000)); do sleep 0.02; done
    [[ $(lines 'served again' hrtc.log) == 0 ]] || fault 'the host is back over a cut link'
    relay_say mend
    wait_for_line hrtc.log "model '$model' is served again by the same host" 10
    wait "$controller" || code=$?
    cat hrtc.log
    ((code == 0)) || fail "hrtc ended with $code"
    [[ $(lines "model '$model'" hrtc.log) == 2 ]] || fault 'not two lines about the host'
    pieces=$(sent_pieces) # Of the time after the cut.
    cat publish.log
    [[ $(lines ' subscribed' publish.log) == 2 && $(lines ' left (' publish.log) == 2 ]] \
        || fault 'the controller was not counted in and out twice'
    stop TERM "$publisher"
    ((stopped_with == 0)) || fault "spm_publish ended with $stopped_with"
    check report.json frames == 8000 wire.host_lost == 1 models.0.host_connected == 1
    check_wire_run report.json
}

# What the lines of list_safety say of the cause `host`: the frame in which it begins to hold, the
# one in which it ends, and the seconds until there is no force. Fails when there was force between,
# or none afterwards. The supervisor's own events tell of its cause alone.
fade() {
    awk '
        $2 == "-" { next }
        { held = $4 ~ /(^|,)host(,|$)/ }
        held && !begun { begun = 1; first = $2; at = $1 }
        held && $3 == "idle" && !faded { faded = 1; time = $1 - at }
        held && $3 == "force" { wrong = 1 }
        begun && !held && !last { last = $2 }
        last && $3 == "force" { back = 1 }
        END {
            if (!begun || !faded || wrong || !last || !back) exit 1
            print first, last, time
        }'
}

start_relay --delay-ms 2
model bumpy-sphere-200000 large.spm
model bumpy-sphere-5000 small.spm

cut_in_mid_run large --pool-mib 2
check report.json safety.begun.host == 1 models.0.static == 0
"$list_safety" report.json | tee events.txt
read -r gone back seconds < <(fade <events.txt) || fail 'the force did not fade and come back'
echo "force off in $seconds s; the host was gone from frame $gone to $back"
readonly fade_s=0.055 # docs/safety.md, "The law", and five frames.
awk -v found="$seconds" -v most="$fade_s" 'BEGIN { exit !(found <= most) }' \
    || was_held_up report.json || fault "the force was there for $seconds s"
((back - gone > 1000)) || fault 'the host was back before the link'
judge_run large.spm "$gone" "$back"
check_span_contact 0 0.1
check_span_contact 2 0.1
((pieces > 0)) || fault 'no chunks after the link was mended'

cut_in_mid_run small
((pieces == 0)) || fault "$pieces pieces of a model that was here as a whole were sent again"
check report.json safety.begun.host == 0 models.0.static == 1
check_contact report.json force.contact_share 0.3
judge_run small.spm
finish
