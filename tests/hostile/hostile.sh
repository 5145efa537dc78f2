#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hostile.sh BIN CHECK_REPORT SANITIZER ATTACKER ATTACK: a stranger on the domain attacks a host and
# a controller in contact; both go on as if it were not there, and name it.
source "$(dirname "$0")/../integration/hrtc/common.sh"
readonly attacker=$4 attack=$5
readonly attacked_for=3
# It is found by everybody and finds hosts.
readonly attacker_uri='<CycloneDDS><Domain id="any"><General><Interfaces><NetworkInterface name="lo"
multicast="false"/></Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery>
<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>9</MaxAutoParticipantIndex>
<LeaseDuration>1 s</LeaseDuration><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain>
</CycloneDDS>'

# Large enough for pieces to come all the time; it moves, so the force follows its poses.
model bumpy-sphere-20000 bumpy.spm
awk 'BEGIN {
    for (i = 0; i <= 200; ++i)
        printf "%.3f bumpy %.6f 0 0 0 0 0 1\n", i / 100, 0.001 * sin(i * 3.14159265 / 100)
}' >swing.txt
start_publisher bumpy.spm --poses swing.txt --poses-loop
start_hrtc --model bumpy --no-static --name victim --device sim:touch --duration 6 \
    --report report.json
wait_for_line publish.log 'controller victim subscribed' 10
sleep 1
CYCLONEDDS_URI=$attacker_uri "$attacker" "$domain" "$attacked_for" "$attack" >attacker.log 2>&1 \
    || fail "the attacker ended badly: $(cat attacker.log)"
grep -Eq '^done [1-9][0-9]+ times' attacker.log || fault "the attacker: $(cat attacker.log)"
code=0
wait "$controller" || code=$?
cat hrtc.log publish.log
((code == 0)) || fail "hrtc ended with $code"

# Nobody went, nothing was dropped, no pose but the host's was taken.
check report.json frames == 6000 wire.host_lost == 0 models.0.pose.followed == 1 \
    models.0.pose.accepted '>' 100 models.0.pose.accepted '<' 1500 \
    models.0.pose.step_max_m '<' 0.002 models.0.pose.refused.not_newer '<=' 3 \
    models.0.pieces_refused == 0 safety.begun.host == 0 safety.begun.jump == 0 \
    scene.objects == 1 force.max_n '>' 0 force.max_n '<=' 3.3
# What is felt is what is felt without it: 1.13 N at most, in steps of 0.09 N.
was_held_up report.json || check report.json force.max_n '<' 1.4 force.max_step_n '<' 0.2
check_contact report.json force.contact_share 0.3
check_clean report.json
[[ $(grep -c 'controller victim subscribed' publish.log) == 1 ]] || fault 'it was subscribed again'
[[ $(grep -c 'controller victim left' publish.log) == 1 ]] || fault 'it was dropped'
(($(wc -l <hrtc.log) < 60 && $(wc -l <publish.log) < 60)) || fault 'the logs are full'

# Who meets a lie counts it and names who told it.
case $attack in
    wanted_flooded_epochs) ;; # To hosts that aren't there: nobody's business.
    wanted_*)
        grep -q 'refused of attacker (process [0-9]* on ' publish.log \
            || fault 'the host names nobody'
        ;;
    *)
        # What is disposed of already can't be again until its host speaks, once a second.
        least=10
        [[ $attack != catalogue_disposed ]] || least=2
        check report.json refused == 1 refused.0.identity '>=' "$least"
        grep -q 'refused of attacker (process [0-9]* on ' hrtc.log || fault 'hrtc names nobody'
        ;;
esac

stop TERM "$publisher"
((stopped_with == 0)) || fault "spm_publish ended with $stopped_with"
finish
