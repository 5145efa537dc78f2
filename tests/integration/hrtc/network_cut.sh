#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_cut.sh: the link is cut during the run, for longer than both sides' leases. Both detect
# it; the force of a partly resident model fades and returns with the link, that of a fully resident
# one stays.
source "$(dirname "$0")/two_networks.sh"

# is_felt_after LINE: true if the server has printed a force since.
is_felt_after() {
    tail -n +$(($1 + 1)) publish.log | grep -Eq '^watch .*; (0\.0?[1-9]|[1-9])[0-9.]* N in contact'
}

# cut_in_mid_run MODEL ARGUMENT...: runs hrtc on that model, with a cut.
cut_in_mid_run() {
    local model=$1
    shift
    start_publisher "$model.spm" --watch
    start_hrtc --model "$model" --device sim:touch --duration 600 --record run.rec \
        --report report.json "$@"
    wait_for_contact publish.log
    relay_say cut
    wait_for_line hrtc.log "server of model '$model' disconnected; the resident data stay in use"
    wait_for_line publish.log ' left ('
    wait_for_more "$controller" # The participants' lease also ends.
    [[ $(lines 'served again' hrtc.log) == 0 ]] || fault 'the server is back over a cut link'
    relay_say restore
    wait_for_line hrtc.log "model '$model' is served again by the same server"
    wait_for_line publish.log ' subscribed' 2
    # A hand that has sunk in too deep first moves out.
    wait_until 'force after the cut' is_felt_after "$(wc -l <publish.log)"
    stop_hrtc
    (($(lines_of_server "$model" hrtc.log) == 2)) || fault 'not two lines about the server'
    pieces=$(sent_pieces) # Pieces of the time after the cut.
    cat publish.log
    [[ $(lines ' subscribed' publish.log) == 2 && $(lines ' left (' publish.log) == 2 ]] \
        || fault 'the controller was not counted in and out twice'
    stop_publisher
    check report.json frames '>' 2000 wire.server_lost == 1 models.0.server_connected == 1
    check_wire_run report.json
}

# Frames of the cause `server` by list_safety: its start, the first without force, and its end.
# Fails if there was force between, or none afterwards. The supervisor's own events contain only its
# cause.
fade() {
    awk '
        $2 == "-" { next }
        { held = $4 ~ /(^|,)server(,|$)/ }
        held && !begun { begun = $2 }
        held && $3 == "idle" && !faded { faded = $2 }
        held && $3 == "force" { wrong = 1 }
        begun && !held && !last { last = $2 }
        last && $3 == "force" { back = 1 }
        END {
            if (!begun || !faded || wrong || !last || !back) exit 1
            print begun, faded, last
        }'
}

start_relay --delay-ms 2
model bumpy-sphere-200000 large.spm
model bumpy-sphere-5000 small.spm

cut_in_mid_run large --pool-mib 2
check report.json safety.begun.server == 1 models.0.static == 0
"$list_safety" report.json | tee events.txt
read -r gone idle back < <(fade <events.txt) || fail 'the force did not fade and come back'
echo "the server was gone from frame $gone to $back, the force off in $idle"
# docs/safety.md, "Fade and rise", and five frames. Fewer if the machine kept some from being run.
((idle - gone <= 55)) || fault "there was force for $((idle - gone)) frames"
judge_run large.spm "$gone" "$back"
check_span_contact 0 0.1
check_span_contact 2 0.1
((pieces > 0)) || fault 'no chunks after the link was mended'

cut_in_mid_run small
((pieces == 0)) || fault "$pieces pieces of a model that was here as a whole were sent again"
check report.json safety.begun.server == 0 models.0.static == 1
check_contact report.json force.contact_share 0.3
judge_run small.spm
finish
