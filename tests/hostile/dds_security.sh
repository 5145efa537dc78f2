#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# dds_security.sh BIN CHECK_REPORT SANITIZER ATTACKER KEYS: the recipe of docs/security.md, executed
# by KEYS. Server and controller with certificates work as without; a program without one discovers
# no participant, and one with a controller's cannot act as a server. A server is identified by its
# certificate.
source "$(dirname "$0")/../integration/hrtc/common.sh"
readonly attacker=$4 keys=$5
if [[ -z "$(find /usr/lib -name libdds_security_auth.so -print -quit)" ]]; then
    echo 'skipped: Cyclone DDS is here without its security plugins'
    exit 77
fi
command -v openssl >/dev/null || {
    echo 'skipped: openssl is needed to make certificates'
    exit 77
}
readonly plain='<CycloneDDS><Domain id="any"><General><Interfaces><NetworkInterface name="lo"
multicast="false"/></Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery>
<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>9</MaxAutoParticipantIndex>
<LeaseDuration>1 s</LeaseDuration><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain>
</CycloneDDS>'

bash "$keys" roles >keys.log || fail "the keys: $(cat keys.log)"
model bumpy-sphere-20000 bumpy.spm
CYCLONEDDS_URI=file://$PWD/roles/server.xml start_publisher bumpy.spm
CYCLONEDDS_URI=file://$PWD/roles/controller.xml start_hrtc --model bumpy --name hand --no-static \
    --device sim:touch --duration 600 --wait "$patience_s" --report report.json
wait_for_line publish.log 'controller hand subscribed'

expect 2 "is not published" "$hrtc" --domain "$domain" --model bumpy --allow-no-rt --wait 2
code=0
ATTACKER_PATIENCE_S=5 CYCLONEDDS_URI=$plain "$attacker" "$domain" 1 catalogue_forged \
    >outsider.log 2>&1 || code=$?
{ [[ $code == 2 ]] && grep -q 'saw no server and controller' outsider.log; } \
    || fault "an outsider ended with $code: $(cat outsider.log)"

# A controller's certificate permits reading and writing a controller's topics only.
for attack in catalogue_forged pose_swing; do
    code=0
    CYCLONEDDS_URI=file://$PWD/roles/controller.xml "$attacker" "$domain" 1 "$attack" \
        >insider.log 2>&1 || code=$?
    { [[ $code == 2 ]] && grep -q 'Not Allowed By Security' insider.log; } \
        || fault "$attack with a controller's certificate ended with $code: $(cat insider.log)"
done

stop_hrtc
cat publish.log
check report.json frames '>' 1000 wire.server_lost == 0 models.0.pieces_refused == 0 \
    models.0.bytes_received '>' 10000 refused == 0
check_contact report.json force.contact_share 0.3
check_clean report.json
stop_publisher

# A restarted server has the same certificate and counts as the same one, without --failover.
secured_publisher() {
    CYCLONEDDS_URI=file://$PWD/roles/server.xml start_publisher bumpy.gltf --scene toy --watch
}
cat >bumpy.gltf <<'GLTF'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [
    {"name": "toy", "extras": {"tactus": {"model": "bumpy.spm"}}}]}
GLTF
secured_publisher
CYCLONEDDS_URI=file://$PWD/roles/controller.xml start_hrtc --scene toy --name hand \
    --device sim:touch --duration 600 --wait "$patience_s" --report report.json
wait_for_contact publish.log hand
stop KILL "$publisher"
wait_for_line hrtc.log "the server of scene 'toy', spm_publish"
secured_publisher
wait_for_line hrtc.log "scene 'toy' now follows spm_publish"
wait_for_contact publish.log hand
stop_hrtc
grep -q "scene 'toy' now follows spm_publish (process $publisher on .*, cert:[0-9a-f]\{12\})" \
    hrtc.log || fault 'the line names no certificate'
check report.json servers.lost == 1 servers.replaced == 1 servers.not_followed == 0
stop_publisher
finish
