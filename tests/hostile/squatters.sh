#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# squatters.sh BIN CHECK_REPORT SANITIZER SQUATTER LYING_HOST ATTACK: unintended servers with the
# intended name. The authority stays with the first; hashed pieces are taken from any. The force is
# checked period by period, compared with a run without them.
source "$(dirname "$0")/../integration/hrtc/common.sh"
source "$(dirname "$0")/force_figures.sh"
readonly squatter=$4 lying_server=$5 attack=$6

model bumpy-sphere-20000 bumpy.spm
scene toy.gltf 'toy bumpy 0'
# Name of a machine in DDS.
machine=$(hostname)
readonly machine

# squat LOG KIND NAME SCENE [COUNT]: starts a squatter; its id is in $squatting.
squat() {
    "$squatter" "$domain" "$2" "$3" "$4" bumpy.spm "${@:5}" >"$1" 2>&1 &
    squatting=$!
    started+=("$squatting")
    wait_for_line "$1" 'ready on DDS domain'
}
# strike LOG: starts a server of the scene that behaves correctly until a tool is near its object;
# its id is in $striking.
strike() {
    "$lying_server" "$domain" bumpy.spm 0.002 strike 0.015 >"$1" 2>&1 &
    striking=$!
    started+=("$striking")
    wait_for_line "$1" 'ready on DDS domain'
}
readonly hand=(--name victim --device sim:touch --tool sphere:0.002)
touch_scene() { # touch_scene ARGUMENT...: runs until stop_hrtc.
    start_hrtc "${hand[@]}" --wait "$patience_s" --duration 600 --report report.json \
        --record attacked.rec "$@"
    wait_for_contact publish.log victim
}
# check_force [SHARE]: checks the force, and contact for at least this part of the correct run's
# share.
check_force() {
    check_clean report.json
    export_force attacked
    read -r growth fall share _ < <(force_figures attacked.csv)
    echo "growth, fall and contact share: honest $honest_growth N, $honest_fall N, $honest_share;" \
        "$attack $growth N, $fall N, $share"
    check report.json force.max_n '>' 0 force.max_n '<=' 3.3
    at_most 'the largest growth a period' "$growth" 0.25
    was_held_up report.json \
        || at_most 'the lack of contact' "$(awk "BEGIN { print ${1:-0} * $honest_share }")" "$share"
}

start_publisher toy.gltf --scene toy
run_hrtc "${hand[@]}" --scene toy --duration 5 --record honest.rec
stop_publisher
export_force honest
read -r honest_growth honest_fall honest_share _ < <(force_figures honest.csv)

# Time by uptime.
now_ms() { awk '{ printf "%.0f", $1 * 1000 }' /proc/uptime; }

case $attack in
    squat_killed | squat_restarted)
        # The chain: an unauthenticated server beside the true one, which then ends, and returns.
        start_publisher toy.gltf --scene toy --watch
        touch_scene --scene toy
        strike strike.log
        wait_for_line hrtc.log "warning: scene 'toy' is offered by a second server, lying_server"
        wait_for_more_frames 500 publish.log victim
        stop KILL "$publisher"
        wait_for_line hrtc.log "the server of scene 'toy', spm_publish"
        wait_for_line hrtc.log "scene 'toy' is now offered by lying_server"
        if [[ $attack == squat_restarted ]]; then
            start_publisher toy.gltf --scene toy --watch
            wait_for_line publish.log "warning: scene 'toy' is offered by lying_server"
            wait_for_line hrtc.log "scene 'toy' is now offered by spm_publish"
        fi
        wait_for_more "$controller" 6000
        stop_hrtc
        check report.json servers.lost == 1 servers.replaced == 0 servers.namesake '>=' 1 \
            servers.not_followed '>=' 1 scene.added == 0 scene.removed == 0 scene.objects == 1 \
            safety.begun.stale '>=' 1 answers.stale '>' 500
        grep -q '^servers .*not followed' hrtc.log || fault 'the summary does not tell'
        check_force
        ;;
    squat_allowed)
        # The same if the former has ended and a restarted server is followed.
        start_publisher toy.gltf --scene toy --watch
        strike strike.log
        touch_scene --scene "toy@$machine:$publisher" --failover any
        wait_for_line hrtc.log "warning: scene 'toy' is offered by a second server, lying_server"
        wait_for_line publish.log "warning: scene 'toy' is offered by lying_server"
        stop TERM "$striking"
        stop KILL "$publisher"
        wait_for_line hrtc.log "the server of scene 'toy', spm_publish"
        start_publisher toy.gltf --scene toy --watch
        began=$(now_ms)
        wait_for_line hrtc.log "scene 'toy' now follows spm_publish"
        echo "followed $(($(now_ms) - began)) ms after it was ready"
        wait_for_contact publish.log victim
        stop_hrtc
        check report.json servers.lost == 1 servers.replaced == 1 \
            scene.added == 1 scene.removed == 1
        check_force
        stop_publisher
        ;;
    squat_first)
        # The first of the two is reported, at the start and by the second server itself; the
        # intended one can be named.
        strike strike.log
        start_publisher toy.gltf --scene toy --watch
        wait_for_line publish.log "warning: scene 'toy' is offered by lying_server"
        touch_scene --scene "toy@$machine:$publisher"
        wait_for_more_frames 500 publish.log victim
        stop_hrtc
        check report.json servers.lost == 0 servers.namesake == 1 servers.pinned == 1
        grep -q '"event": "pinned"' report.json || fault 'the report names no server'
        grep -Eq "\"server\": \"spm_publish \(process $publisher on" report.json \
            || fault 'the report names another server'
        check_force 0.7
        stop_publisher
        ;;
    twin_*)
        # The same model, hash and scene, discovered first.
        kind=${attack#twin_}
        count=
        [[ $kind != claque ]] || count=40
        squat twin.log "$kind" bumpy - $count
        start_publisher bumpy.spm --watch
        wait_for_line publish.log "warning: model 'bumpy' is offered by squatter"
        began=$(now_ms)
        touch_scene --model bumpy --no-static --pool-mib 1
        echo "in contact $(($(now_ms) - began)) ms after the start"
        wait_for_more_frames 2000 publish.log victim
        stop_hrtc
        grep -q "warning: model 'bumpy' is offered by a second server" hrtc.log \
            || fault 'no word of the second server'
        check report.json servers.namesake '>=' 1 wire.server_lost == 0 \
            models.0.pieces_overdue == 0 safety.begun.starved == 0
        [[ $kind == forger ]] || check report.json models.0.pieces_refused == 0
        check_force 0.5
        stop_publisher
        ;;
    crowd)
        # 40 participants with 256 models each, before the start and during the server's restart.
        squat crowd.log crowd bumpy - 40
        start_publisher toy.gltf --scene toy --watch
        began=$(now_ms)
        touch_scene --scene toy --failover "$machine"
        echo "in contact $(($(now_ms) - began)) ms after the start"
        stop KILL "$publisher"
        wait_for_line hrtc.log "the server of scene 'toy', spm_publish"
        start_publisher toy.gltf --scene toy --watch
        began=$(now_ms)
        wait_for_line hrtc.log "scene 'toy' now follows spm_publish"
        echo "followed $(($(now_ms) - began)) ms after it was ready"
        wait_for_contact publish.log victim
        wait_for_more_frames 500 publish.log victim
        stop_hrtc
        check report.json servers.lost == 1 servers.replaced == 1
        check_force
        stop_publisher
        ;;
    *) fail "there is no attack $attack" ;;
esac
finish
