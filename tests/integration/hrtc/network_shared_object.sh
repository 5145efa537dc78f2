#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_shared_object.sh: two controllers touch one moving object, 10 ms from its server and with
# one datagram in a hundred lost. Its server dies, and the object with it; another server with the
# same scene takes over by --failover, and both touch its object instead.
source "$(dirname "$0")/two_networks.sh"

# Swing of 3 mm to either side in x within a second, 100 poses a second.
awk 'BEGIN {
    for (i = 0; i <= 100; ++i)
        printf "%.3f ball %.6f 0 0 0 0 0 1\n", i / 100, 0.003 * sin(i * 3.14159265 / 50)
}' >swing.txt

# start_controller NAME: starts a controller of that name; its output is in NAME.log, its id in
# $controller.
start_controller() {
    "${on_controller[@]}" "$hrtc" --allow-no-rt --domain "$domain" \
        "${controller_security[@]}" --scene shared --failover any \
        --name "$1" --device sim:touch --duration 600 --wait "$patience_s" \
        --report "$1.json" >"$1.log" 2>&1 &
    controller=$!
    started+=("$controller")
}

# start_server FILE: starts a server with its output in FILE.
start_server() {
    start_publisher ball.spm --scene shared --poses swing.txt --poses-loop --watch
    mv publish.log "$1" # The server continues to write there.
}

# touch_both FILE: both touch their server's object, and continue.
touch_both() {
    local name
    for name in left right; do
        wait_for_contact "$1" "$name"
        wait_for_more_frames 500 "$1" "$name"
    done
}

start_relay --delay-ms 10 --loss 0.01 --seed 7
model bumpy-sphere-5000 ball.spm
# A machine that stalls a server longer than its liveliness makes the controllers take the other
# one: the run is then repeated with a note, five times in all.
for try in 1 2 3 4 5; do
    start_server first.log
    first=$publisher
    start_controller left
    left=$controller
    start_controller right
    right=$controller
    wait_for_line first.log ' subscribed' 2
    start_server second.log
    touch_both first.log
    [[ $(lines ' subscribed' second.log) != 0 ]] || break
    ((try < 5)) || fail 'the second server was asked'
    echo "held up by the machine, run $try"
    for id in "$left" "$right" "$first" "$publisher"; do
        stop KILL "$id"
    done
    sleep 2 # Longer than a lease: no event reports that both leases have ended.
done
stop KILL "$first"
wait_for_line left.log "model 'ball' is served again, by another server"
wait_for_line second.log ' subscribed' 2
touch_both second.log
for name in left right; do
    controller=${!name}
    mv "$name.log" hrtc.log
    stop_hrtc
    # Objects of both servers were followed, one at a time; nothing was mixed, and the model was
    # never without a server.
    check "$name.json" frames '>' 1500 models == 1 scene.objects == 1 \
        scene.objects_max == 1 scene.added == 1 scene.removed == 1 scene.ignored == 0 \
        scene.changes_refused.not_here == 0 scene.changes_refused.already_here == 0 \
        scene.changes_refused.old_generation == 0 scene.changes_refused.bad_pose == 0 \
        models.0.pose.followed == 1 models.0.pose.accepted '>' 50 \
        models.0.pose.moves '>' 100 models.0.pose.refused.rotation == 0 \
        models.0.pose.step_max_m '<' 0.01 models.0.pieces_refused == 0 wire.server_lost == 0 \
        force.max_n '>' 0 force.max_n '<=' "$touch_force_max_n" \
        answers.exact+answers.separated+answers.within_tolerance+answers.bounded+answers.stale \
            == '1*frames'
    check_contact "$name.json" force.contact_share 0.3
    check_clean "$name.json"
    # After the server's death the object was stale after 100 ms, and then gone: the force faded for
    # about 50 ms and did not end at once.
    check "$name.json" answers.stale '>' 0
    "$list_safety" "$name.json" | awk '
        $4 == "stale" && $3 == "brake" { began = $2 }
        $4 == "stale" && $3 == "idle" && $2 - began >= 25 && $2 - began <= 55 { faded = 1 }
        END { exit !faded }' || was_held_up "$name.json" || fault "$name: the force did not fade"
done
stop_publisher
finish
