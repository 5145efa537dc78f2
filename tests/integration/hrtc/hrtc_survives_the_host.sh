#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_survives_the_host.sh: a host that is killed in mid-run is one line and a note in the report,
# and code 1 with --strict; one that comes back is used again.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-40000 bumpy.spm

# lines TEXT: how many lines of hrtc's hold it.
lines() { grep -cF -- "$1" hrtc.log || true; }

# end_well FRAMES LINES CODE: the controller ends by itself, having run them all and said that many
# lines about its model.
end_well() {
    local code=0
    wait "$controller" || code=$?
    cat hrtc.log
    ((code == $3)) || fail "hrtc ended with $code"
    grep -q '^verdict .*the host went away' hrtc.log || fault 'the verdict does not tell'
    [[ $(lines "host of model 'bumpy' is gone; going on with what is resident") == 1 ]] \
        || fault 'not one line that the host is gone'
    [[ $(lines "model 'bumpy'") == "$2" ]] || fault "not $2 lines about the host"
    check report.json frames == "$1" wire.host_lost == 1 force.max_n '>' 0 safety.begun.host == 1
    check_clean report.json
}

start_publisher bumpy.spm --watch
start_hrtc --model bumpy --duration 3 --report report.json --strict
wait_for_frames 500 publish.log
stop KILL "$publisher"
end_well 3000 1 1
[[ $(lines 'is served again') == 0 ]] || fault 'a host is said to be back that is not'
check report.json models.0.host_connected == 0

start_publisher bumpy.spm --watch
start_hrtc --model bumpy --duration 5 --report report.json
wait_for_frames 500 publish.log
stop KILL "$publisher"
wait_for_line hrtc.log 'is gone' 3
start_publisher bumpy.spm
end_well 5000 2 0
[[ $(lines 'is served again') == 1 ]] || fault 'not one line that a host is back'
check report.json models.0.host_connected == 1
finish
