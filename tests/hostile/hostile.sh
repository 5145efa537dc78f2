#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hostile.sh BIN CHECK_REPORT SANITIZER ATTACKER ATTACK: an unauthenticated peer on the domain
# attacks a server and a controller in contact; both continue unaffected, and name it. A flooded
# server still has capacity for another controller, which joins meanwhile.
source "$(dirname "$0")/../integration/hrtc/common.sh"
source "$(dirname "$0")/strangers.sh"
readonly attacker=$4 attack=$5

only_printable() { # only_printable FILE
    if LC_ALL=C grep -q '[^[:print:][:space:]]' "$1"; then
        fault "$1 holds what is not text"
    fi
}

# Large enough that pieces arrive constantly; it moves, so the force follows its poses.
model bumpy-sphere-20000 bumpy.spm
awk 'BEGIN {
    for (i = 0; i <= 200; ++i)
        printf "%.3f bumpy %.6f 0 0 0 0 0 1\n", i / 100, 0.001 * sin(i * 3.14159265 / 100)
}' >swing.txt
start_publisher bumpy.spm --poses swing.txt --poses-loop --watch
start_hrtc --model bumpy --no-static --name victim --device sim:touch --duration 600 \
    --report report.json
wait_for_line publish.log 'controller victim subscribed'
wait_for_contact publish.log victim
ports=()
[[ "$attack" != rtps_* ]] || mapfile -t ports < <(udp_ports "$publisher" && udp_ports "$controller")
CYCLONEDDS_URI=$stranger_uri "$attacker" "$domain" 0 "$attack" "${ports[@]}" >attacker.log 2>&1 &
attacking=$!
started+=("$attacking")
if [[ "$attack" == *_flooded* ]]; then
    code=0
    "$hrtc" --allow-no-rt --domain "$domain" --model bumpy --no-static --name late \
        --device sim:touch --duration 0.5 --wait "$patience_s" --report late.json >late.log 2>&1 \
        || code=$?
    ((code == 0)) || fault "a controller that came meanwhile ended with $code: $(cat late.log)"
    check late.json frames == 500
fi
code=0
wait "$attacking" || code=$?
((code == 0)) || fail "the attacker ended badly: $(cat attacker.log)"
least=10
[[ "$attack" != *_deaf ]] || least=2 # One packet each time suffices.
crowd='[0-9]{4,} participants are on this domain'
forge_more() { # The kernel drops the part of a flood that exceeds its buffers.
    grep -Eqs "$crowd" publish.log && return
    CYCLONEDDS_URI=$stranger_uri "$attacker" "$domain" 0 "$attack" "${ports[@]}" \
        >attacker.log 2>&1 || fail "the attacker ended badly: $(cat attacker.log)"
    return 1
}
[[ "$attack" != rtps_participants ]] || wait_until 'count of participants' forge_more
turns=$(sed -n 's/^done \([0-9]*\) times.*/\1/p' attacker.log)
((turns >= least)) || fault "the attacker: $(cat attacker.log)"
[[ "$attack" == rtps_* ]] || wait_for_more_frames 0 publish.log victim
stop_hrtc
# A flooded server is slow. Events that alternate constantly use up the lines of that second, so
# that of the victim's end may be left out.
goes=1
[[ "$attack" != log_flooded && "$attack" != controllers_flooded ]] || goes=0
((goes == 0)) || wait_for_line publish.log 'controller victim left'
cat publish.log
check_clean report.json
only_printable hrtc.log
only_printable publish.log
taken_kib=$(memory_kib "$publisher")
most_kib=60000
[[ "$attack" != controllers_flooded ]] || most_kib=$((most_kib + 50 * 5 * 1024)) # 4 writers each.
[[ -n "$sanitizer" ]] || ((taken_kib < most_kib)) || fault "the server took $taken_kib KiB"
check_sizes hrtc.log publish.log

# A foreign identity can be forged on the wire: its earlier messages may then end a service, and the
# force fades.
if [[ "$attack" == rtps_* ]]; then
    check report.json frames '>' 500 force.max_n '>' 0 force.max_n '<=' 3.3
    case $attack in
        rtps_motion_deaf)
            # Waits until the server reports the motion through another writer.
            grep -q 'controller victim receives no motion: a new writer' publish.log \
                || fault 'the server made no other writer'
            grep -Eq 'motion of server .* was lost for [0-9]+ ms by a forged packet' hrtc.log \
                || fault 'hrtc tells nothing'
            # Motion from the other writer is accepted.
            check report.json scene.motion_regained '>=' 2 models.0.pose.refused.not_newer '<=' 20
            ;;
        rtps_pieces_deaf)
            grep -q "pieces don't reach controller victim: new writers" publish.log \
                || fault 'the server made no other writers'
            ;;
        rtps_participants)
            grep -Eqs "$crowd" publish.log || fault 'the server counts no participants'
            ;;
    esac
    was_held_up report.json || check report.json force.max_step_n '<' 0.45
    stop_publisher
    finish
    exit 0
fi

# No participant left, nothing was dropped, only the server's poses were accepted.
check report.json frames '>' 500 models.0.pose.followed == 1 models.0.pose.accepted '>' 50 \
    models.0.pose.step_max_m '<' 0.002 models.0.pose.refused.not_newer '<=' 3 \
    models.0.pieces_refused == 0 safety.begun.jump == 0 \
    scene.objects == 1 force.max_n '>' 0 force.max_n '<=' 3.3
# The force is that without the attack: 1.13 N at most, in steps of 0.09 N. If the machine stalled
# the loop or the server, the force fades, and the hand sinks in meanwhile; it may stall the server
# longer than its lease.
if ! was_held_up report.json && "$check_report" report.json safety.begun.stale == 0 >/dev/null; then
    check report.json force.max_n '<' 1.4 force.max_step_n '<' 0.2 wire.server_lost == 0 \
        safety.begun.server == 0
fi
check_contact report.json force.contact_share 0.3
[[ $(grep -c 'controller victim subscribed' publish.log) == 1 ]] || fault 'it was subscribed again'
left=$(grep -c 'controller victim left' publish.log) || true
((left >= goes && left <= 1)) || fault 'it was dropped'
grep -q '^served victim: [0-9]* pieces/s' publish.log || fault '--watch tells no rates'

# A receiver of false data counts it and names its sender.
case $attack in
    wanted_flooded_epochs) ;; # For absent servers: ignored by all.
    log_flooded) # The log reports its starts and ends 40 times a second at most.
        grep -q 'controller stranger subscribed' publish.log || fault 'no stranger came'
        said=$(grep -c 'controller stranger' publish.log)
        ((said <= 40 * (SECONDS + 1))) || fault "$said lines of a stranger's visits"
        ;;
    controllers_flooded) # More than a server accepts of one process.
        grep -q 'refused from attacker .*: more pieces requested in a second' publish.log \
            || fault 'the server tells of no rate'
        ;;&
    controllers_flooded | participants_flooded)
        grep -Eq 'attacker .* has [0-9]+ participants on this domain' publish.log \
            || fault 'the server counts no participants'
        ;;
    endpoints_flooded) ;; # They belong to no service.
    wanted_* | telemetry_*)
        grep -q 'refused from attacker (process [0-9]* on ' publish.log \
            || fault 'the server names nobody'
        grep -q '^refusals from attacker.*: [0-9]* more, ' publish.log \
            || fault '--watch names nobody'
        ! grep -q '77777777' publish.log || fault 'forged telemetry is shown'
        ;;
    *)
        # A disposed instance cannot be disposed again until its server writes. Each of a flood is
        # refused on arrival, not at its end; of its own names those beyond the limit.
        least=10
        [[ $attack != *_disposed ]] || least=1
        [[ $attack != *_flooded ]] || least=$((turns / 2))
        check report.json refused == 1 refused.0.identity '>=' "$least"
        [[ $attack != catalogue_flooded ]] || check report.json refused.0.model_number '>=' 1
        [[ $attack != objects_flooded ]] || check report.json refused.0.object_number '>=' 1
        grep -q 'refused from attacker (process [0-9]* on ' hrtc.log || fault 'hrtc names nobody'
        ;;
esac

stop_publisher
finish
