# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2034 # The scripts use what is set here.
# common.sh with server and controller in separate networks and a relay between them; sourced with
# "$@" being BIN CHECK_REPORT SANITIZER NETWORK_RELAY LIST_SAFETY JUDGE_RECORDING. After start_relay
# all programs of common.sh start in their networks. A machine that cannot create networks skips
# (77).
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
readonly network_relay=$4 list_safety=$5 judge_recording=$6
# Limits of a device of the class touch: platform/devices/simulated/device_classes.hpp.
readonly touch_force_max_n=3.3

# skip_without_networks: ends the script if networks cannot be created.
skip_without_networks() {
    local reason=''
    ((EUID == 0)) || reason='only root may make networks'
    [[ -c /dev/net/tun ]] || reason='there is no /dev/net/tun'
    [[ -n "$reason" ]] || unshare --net true 2>unshare.log || reason=$(tail -n 1 unshare.log)
    [[ -z "$reason" ]] || { printf 'skipped: %s\n' "$reason"; exit 77; }
}

# start_relay ARGUMENT...: returns when both networks are up; its id is in $relay.
start_relay() {
    local ready side='"fd":([0-9]+),[^}]*"dds":"([^"]+)"'
    skip_without_networks
    coproc relay_process { exec "$network_relay" "$@" 2>relay.log; }
    relay=${relay_process_PID:?}
    relay_in=${relay_process[1]}
    relay_out=${relay_process[0]}
    started+=("$relay")
    read -r -t "$patience_s" ready <&"$relay_out" || fail "network_relay $*: $(cat relay.log)"
    [[ "$ready" =~ \"server\":\{$side\},\"controller\":\{$side\} ]] || fail "not ready: $ready"
    local part=("${BASH_REMATCH[@]}")
    # Both exec the started program, so that its id is that of the process.
    on_server=(nsenter "--net=/proc/$relay/fd/${part[1]}" env "CYCLONEDDS_URI=${part[2]}")
    on_controller=(nsenter "--net=/proc/$relay/fd/${part[3]}" env "CYCLONEDDS_URI=${part[4]}")
    server_security=(--plain)
    controller_security=(--plain)
    [[ -z "${TACTUS_TEST_SECURED:-}" ]] || use_keys
}

in_server_network() { "${on_server[@]}" "$@"; }
in_controller_network() { "${on_controller[@]}" "$@"; }

# relay_say COMMAND: stores the answer in $relay_answer.
relay_say() {
    printf '%s\n' "$*" >&"$relay_in"
    read -r -t "$patience_s" relay_answer <&"$relay_out" || fail "the relay says nothing to '$*'"
    [[ "$relay_answer" != refused* ]] || fail "the relay to '$*': $relay_answer"
}

# count_frames FILE: writes the relay's counts, for check; only intended losses occurred.
count_frames() {
    relay_say count
    printf '%s\n' "$relay_answer" | tee "$1"
    for direction in to_controller to_server; do
        check "$1" "$direction.udp_datagrams" '>' 0 \
            "$direction.dropped_full+$direction.missed+$direction.refused_by_system" == 0
    done
}

# touch_large_model: a streamed model is published and touched for two seconds, and no answer is
# wrong.
touch_large_model() {
    model bumpy-sphere-100000 large.spm
    start_publisher large.spm
    run_hrtc --model large --device sim:touch --pool-mib 2 --duration 2 --record run.rec
    check report.json frames == 2000 wire.server_lost == 0 safety.begun.server == 0 \
        answers.exact+answers.separated+answers.within_tolerance '>' '0.9*frames'
    check_wire_run report.json
    check_contact report.json force.contact_share 0.3
    judge_run large.spm
}

# judge_run MODEL_FILE [FRAME]...: judges run.rec against the whole source into judged.json: no
# answer was wrong. Given frames divide it into spans.
judge_run() {
    "$judge_recording" run.rec "$@" >judged.json || fail 'the recording does not replay'
    check judged.json frames == "$(recorded_frames)" violations == 0
    cat judged.json
}
# check_span_contact SPAN SHARE: expects more than this share of that span of judged.json in
# contact, unless the machine stalled the loop: then the force was off, and the hand lost the
# contact.
check_span_contact() {
    was_held_up report.json \
        || check judged.json "spans.$1.contact_frames" '>' "$2*spans.$1.frames"
}
recorded_frames() { sed -n 's/^recording *\([0-9]*\) frames.*/\1/p' hrtc.log; }

# check_wire_run FILE: checks the laws of every run with a streamed model on any link.
check_wire_run() {
    check "$1" models.0.pieces_refused == 0 faults.model_inconsistent == 0 cache.loads '>' 0 \
        force.max_n '>' 0 force.max_n '<=' "$touch_force_max_n" \
        answers.exact+answers.separated+answers.within_tolerance+answers.bounded+answers.stale \
            == '1*frames'
    check_clean "$1"
}


# sent_pieces: prints the pieces that the server sent in the last subscription, after all have
# ended.
sent_pieces() {
    wait_for_line publish.log ' left (' "$(lines ' subscribed' publish.log)"
    sed -n 's/.* left (\([0-9]*\) pieces, .*/\1/p' publish.log | tail -n 1
}
