#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_loss.sh: a link that loses one frame in a hundred each way, duplicates another one, and
# reorders them. Nothing is refused for its content, duplicates are taken once, and no answer is
# wrong.
source "$(dirname "$0")/two_networks.sh"

start_relay --delay-ms 2 --jitter-ms 2 --loss 0.01 --duplicates 0.01 --seed 7
touch_large_model

count_frames counts.json
for direction in to_controller to_server; do
    check counts.json $direction.lost '>' 0 $direction.duplicated '>' 0 \
        $direction.lost '<' "0.05*$direction.frames"
done
pieces=$(sent_pieces)
echo "the server sent $pieces pieces"
check report.json cache.loads '<=' "$pieces" cache.loads '>' 20
stop TERM "$relay"
((stopped_with == 0)) || fault "network_relay ended with $stopped_with"
finish
