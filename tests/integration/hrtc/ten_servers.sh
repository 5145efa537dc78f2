#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ten_servers.sh: a machine has capacity for ten servers and watchers on a domain: each of ten is
# found and touched, the eleventh reports the used ports.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 ball.spm

servers=10
for ((i = 1; i <= servers; ++i)); do
    start_publisher ball.spm --name "ball-$i"
    mv publish.log "server-$i.log" # The server continues to write there.
done
code=0
"$publish" --domain "$domain" --seconds 5 ball.spm --name ball-11 >said.txt 2>&1 || code=$?
((code == 2)) || fault "the eleventh server ended with $code"
grep -q "DDS domain $domain cannot be joined: .* 'ss -ulpn' lists them" said.txt \
    || fault "the eleventh server is not told why: $(<said.txt)"
for i in 1 "$servers"; do
    contact=0 run_hrtc --model "ball-$i" --duration 0.2
    check report.json frames == 200 wire.server_lost == 0
done
stop_publisher # The tenth: its place is free again.
start_publisher ball.spm --name ball-11
finish
