#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_shared_object.sh: two controllers touch one object that moves, 10 ms from its host and
# with one datagram in a hundred lost. Its host dies and takes it along; another host with the same
# scene steps in, and both touch its object instead.
source "$(dirname "$0")/two_networks.sh"
readonly seconds=12

# A swing of 3 mm to either side in x within a second, 100 poses a second.
awk 'BEGIN {
    for (i = 0; i <= 100; ++i)
        printf "%.3f ball %.6f 0 0 0 0 0 1\n", i / 100, 0.003 * sin(i * 3.14159265 / 50)
}' >swing.txt

# start_controller NAME: it is called so, its words are in NAME.log, its id in $controller.
start_controller() {
    "${on_controller[@]}" "$hrtc" --allow-no-rt --domain "$domain" --scene shared \
        --name "$1" --device sim:touch --duration "$seconds" --report "$1.json" >"$1.log" 2>&1 &
    controller=$!
    started+=("$controller")
}

# start_host FILE: it stays, its words are in FILE.
start_host() {
    start_publisher ball.spm --scene shared --poses swing.txt --poses-loop --watch
    mv publish.log "$1" # The host goes on writing there.
}

# check_watched FILE: that host saw each of the two touch its model, with a force.
check_watched() {
    local name
    for name in left right; do
        grep -q "^watch $name: .* N in contact" "$1" || fault "$1: $name never touched"
    done
}

start_relay --delay-ms 10 --loss 0.01 --seed 7
model bumpy-sphere-5000 ball.spm
# A machine that holds a host up for longer than its liveliness makes the controllers take the other
# one: then it says so and begins again, three times in all.
for try in 1 2 3; do
    start_host first.log
    first=$publisher
    start_controller left
    left=$controller
    start_controller right
    right=$controller
    wait_for_lines 2 ' subscribed' first.log
    start_host second.log
    wait_for_frames 3000 first.log left
    wait_for_frames 3000 first.log right
    [[ $(lines ' subscribed' second.log) != 0 ]] || break
    ((try < 3)) || fail 'the second host was asked'
    echo "held up by the machine, run $try"
    for id in "$left" "$right" "$first" "$publisher"; do
        stop KILL "$id"
    done
    sleep 2 # Until nobody believes in them any more.
done
killed_ms=$(now_ms)
stop KILL "$first"
wait_for_lines 1 "model 'ball' is served again, by another host" left.log
check_notice left.log "$killed_ms"
wait_for_lines 2 ' subscribed' second.log
for id in "$left" "$right"; do
    code=0
    wait "$id" || code=$?
    ((code == 0)) || fail "a controller ended with $code: $(cat left.log right.log)"
done
cat left.log right.log
check_watched first.log
check_watched second.log
for name in left right; do
    # What both hosts showed was followed, one object at a time; nothing was mixed up, and the model
    # was never without a host.
    check "$name.json" frames == "${seconds}000" models == 1 scene.objects == 1 \
        scene.objects_max == 1 scene.came == 1 scene.went == 1 scene.passed_over == 0 \
        scene.changes_refused.not_here == 0 scene.changes_refused.already_here == 0 \
        scene.changes_refused.old_generation == 0 scene.changes_refused.bad_pose == 0 \
        models.0.pose.followed == 1 models.0.pose.accepted '>' 500 \
        models.0.pose.moves '>' 3000 models.0.pose.refused.rotation == 0 \
        models.0.pose.step_max_m '<' 0.01 models.0.pieces_refused == 0 wire.host_lost == 0 \
        force.max_n '>' 0 force.max_n '<=' "$touch_force_max_n" \
        answers.exact+answers.decided+answers.bracket+answers.stale == '1*frames'
    check_contact "$name.json" force.contact_share 0.3
    check_clean "$name.json"
    # When the host died the object was stale after 100 ms, and then gone: the force faded for some
    # 50 ms and was not let go at once.
    check "$name.json" answers.stale '>' 100
    "$list_safety" "$name.json" | awk '
        $4 == "stale" && $3 == "brake" { began = $2 }
        $4 == "stale" && $3 == "idle" && $2 - began >= 25 && $2 - began <= 55 { faded = 1 }
        END { exit !faded }' || was_held_up "$name.json" || fault "$name: the force did not fade"
done
stop TERM "$publisher"
((stopped_with == 0)) || fault "the second host ended with $stopped_with"
finish
