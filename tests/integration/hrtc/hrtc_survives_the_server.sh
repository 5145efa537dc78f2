#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_survives_the_server.sh: a server killed during the run is one line and a note in the report,
# and code 1 with --strict; pieces of a restarted one are used again, but its authority is not
# accepted without --failover, and a line reports that.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-60000 bumpy.spm

# lose_server ARGUMENT...: kills the server of a touching controller.
lose_server() {
    start_publisher bumpy.spm --watch
    start_hrtc --model bumpy --duration 600 --report report.json "$@"
    wait_for_contact publish.log
    stop KILL "$publisher"
    wait_for_line hrtc.log "server of model 'bumpy' disconnected; the resident data stay in use"
}
# check_loss LINES: the summary and the report contain the one loss, with this number of lines about
# the model.
check_loss() {
    grep -q '^verdict .*the server was lost' hrtc.log || fault 'the verdict does not tell'
    [[ $(lines "server of model 'bumpy' disconnected; the resident data stay" hrtc.log) == 1 ]] \
        || fault 'not one line that the server is gone'
    (($(lines_of_server bumpy hrtc.log) == $1)) || fault "not $1 lines about the server"
    check report.json wire.server_lost == 1 force.max_n '>' 0 safety.begun.server == 1
    check_clean report.json
}

lose_server --strict
wait_for_more "$controller"
kill -TERM "$controller"
end_hrtc 1
check_loss 1
[[ $(lines 'is served again' hrtc.log) == 0 ]] || fault 'a server is said to be back that is not'
check report.json frames '>' 1000 models.0.server_connected == 0

lose_server
start_publisher bumpy.spm --watch
wait_for_line hrtc.log 'is served again'
wait_for_line publish.log ' subscribed'
stop_hrtc
check_loss 3
grep -q "model 'bumpy' is now offered by spm_publish .*: its pieces are used" hrtc.log \
    || fault 'no line that the other server is not followed'
[[ $(lines 'is served again' hrtc.log) == 1 ]] || fault 'not one line that a server is back'
check report.json models.0.server_connected == 1 servers.lost == 1 servers.replaced == 0 \
    servers.not_followed == 1
finish
