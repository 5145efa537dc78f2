#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_half_cut.sh: for longer than the lease, nothing passes from the server to the controller.
# Only the controller loses the other side. It is served again by the same server afterwards; with
# keys, after both sides have begun a new handshake.
source "$(dirname "$0")/two_networks.sh"

start_relay --delay-ms 2
model bumpy-sphere-20000 large.spm
start_publisher large.spm --watch
start_hrtc --model large --device sim:touch --no-static --duration 600 --report report.json
wait_for_contact publish.log
relay_say cut to-controller
wait_for_line hrtc.log "server of model 'large' disconnected"
wait_for_more "$controller" # The participant's lease also ends.
relay_say restore
wait_for_line hrtc.log "model 'large' is served again by the same server"
silences=$(lines 'its handshake does not end: silent for' hrtc.log)
if [[ -n "${TACTUS_TEST_SECURED:-}" ]]; then
    ((silences > 0)) || fault 'the handshake ended by itself: HandshakeWatch is not needed'
else
    ((silences == 0)) || fault 'silent without keys'
fi
wait_for_more_frames 500 publish.log
stop_hrtc
stop_publisher
check report.json frames '>' 1000 wire.server_lost == 1 models.0.server_connected == 1
check_wire_run report.json
finish
