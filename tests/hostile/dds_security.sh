#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# dds_security.sh BIN CHECK_REPORT SANITIZER INTRUDER LAX_LIBRARY: server and controller with keys
# of tactus-keys work as without. A stranger without keys, with those of another authority, with
# revoked keys or with forged rights reads nothing, and no program reads its data. A controller
# reads nothing that is for another one, a viewer only telemetry, even if their own plugin checks
# nothing. A server is identified by its certificate.
source "$(dirname "$0")/../integration/hrtc/common.sh"
source "$(dirname "$0")/strangers.sh"
readonly intruder=$4 lax=$5
command -v openssl >/dev/null || {
    echo 'skipped: openssl is needed to forge documents'
    exit 77
}
use_keys
readonly station=machines/station hand=machines/hand-1 other=machines/hand-2 desk=machines/desk

# intrude KEYS LIBRARY read|write PARTITION: in intruder.log; its exit code is in $intruded_with.
intrude() {
    intruded_with=0
    CYCLONEDDS_URI=$stranger_uri "$intruder" "$domain" "$@" 3 >intruder.log 2>&1 || intruded_with=$?
}
# intrude_until PATTERN ARGUMENT...: the same, again until a line of intruder.log matches, at most
# ten times. On a busy machine a handshake can take longer than one attempt.
intrude_until() {
    for _ in {1..10}; do
        intrude "${@:2}"
        ! grep -Eq "$1" intruder.log || return 0
    done
    fault "'${*:2}' never had '$1': $(cat intruder.log)"
}
# sees TOPIC: whether the last one had samples of it.
sees() { grep -Eq "^$1 matched [0-9]+ samples [1-9]" intruder.log; }
# sees_nothing NAME [LOG]: all six topics were tried, and none matched.
sees_nothing() {
    local log=${2:-intruder.log}
    [[ $(grep -Ec ' matched 0 | refused$' "$log") == 6 ]] || fault "$1: $(cat "$log")"
}
# sees_nothing_in KEYS read|write PARTITION...: the same in each partition, all at a time.
sees_nothing_in() {
    local at intruders=()
    for at in $(seq 3 $#); do
        CYCLONEDDS_URI=$stranger_uri "$intruder" "$domain" "$1" "$lax" "$2" "${!at}" 3 \
            >"intruder.$at.log" 2>&1 &
        intruders+=($!)
    done
    wait "${intruders[@]}"
    for at in $(seq 3 $#); do
        sees_nothing "$1 would $2 in '${!at}'" "intruder.$at.log"
    done
}

model bumpy-sphere-20000 bumpy.spm
start_publisher bumpy.spm
start_hrtc --model bumpy --no-static --device sim:touch --duration 600 --wait "$patience_s" \
    --report report.json
wait_for_line publish.log 'controller hand-1 subscribed'

# Without keys, and what every program says of others that are wrong.
expect 2 'is not published' "$hrtc" --domain "$domain" --model bumpy --allow-no-rt --wait 2
for way in read write; do
    intrude - - "$way" '*'
    sees_nothing "a stranger that would $way"
done
refuse() { expect 2 "$1" "$hrtc" --domain "$domain" --model bumpy --allow-no-rt --wait 5 "${@:2}"; }
refuse "can't be shown with the keys of 'hand-2'" --security "$other" --name hand-1
refuse 'is no folder' --security nowhere
cp -r "$other" wrong
chmod 604 wrong/identity.key
refuse 'other users may read identity.key' --security wrong
chmod 600 wrong/identity.key
sed -i 's/hand-2/hand-1/' wrong/permissions.p7s
refuse 'permissions.p7s was changed' --security wrong
expect 2 'is no folder' "$publish" bumpy.spm --domain "$domain" --security nowhere
expect 2 "domain 231 can't be protected" "$publish" bumpy.spm --domain 231 --security "$station"
CYCLONEDDS_URI='<CycloneDDS/>' expect 2 'names a network' "$publish" bumpy.spm \
    --domain "$domain"

# What each role may read. The readers' own plugin checks nothing: the writers' does.
readonly samples='matched [0-9]+ samples [1-9]'
intrude_until "^telemetry $samples" "$desk" - read '*'
intrude_until "^telemetry $samples" "$desk" "$lax" read '*'
for topic in catalogue objects motion wanted chunks; do
    ! sees "$topic" || fault "a viewer sees $topic: $(cat intruder.log)"
done
intrude_until "^catalogue $samples" "$other" "$lax" read ''
sees_nothing_in "$other" read '*' 'hand-1' 'hand-1.*' 'hand-?.*' 'hand*'
intrude_until '^chunks matched [1-9]' "$hand" "$lax" read 'hand-1.*'

# What they may write.
for keys_of in "$other" "$desk"; do
    sees_nothing_in "$keys_of" write '' '*' 'server.*' 'hand-1' 'hand-1.*'
done
intrude_until '^wanted matched [1-9]' "$other" "$lax" write hand-2

# Another authority's keys of the same names.
"$keys" --domain "$domain" --servers station --controllers hand-1 --authority theirs \
    --output their >keys.log
for name in station hand-1; do
    intrude "their/$name" "$lax" read '*'
    sees_nothing "$name of another authority"
done

# Rights that a controller signed by itself, below the authority of identities.
rm -rf wrong
cp -r "$other" wrong
cp wrong/identity_ca.pem wrong/permissions_ca.pem
for document in governance permissions; do
    openssl smime -verify -noverify -text -in "$station/$document.p7s" 2>openssl.log \
        | sed 's/station/hand-2/g' >document.xml
    openssl smime -sign -text -in document.xml -out "wrong/$document.p7s" \
        -signer wrong/identity.pem -inkey wrong/identity.key 2>openssl.log
done
intrude wrong "$lax" read '*'
((intruded_with == 0)) || fault "rights of its own making are no test: $(cat intruder.log)"
sees_nothing 'a controller with rights of its own making'

stop_hrtc
check report.json frames '>' 1000 wire.server_lost == 0 models.0.pieces_refused == 0 \
    models.0.bytes_received '>' 10000 refused == 0
check_contact report.json force.contact_share 0.3
check_clean report.json
stop_publisher

# Revoked, where the server has the new list: the one that is revoked has the old one.
cp -r "$other" stolen
"$keys" --domain "$domain" --servers station --controllers hand-1 hand-2 --viewers desk \
    --revoke hand-2 >keys.log
start_publisher bumpy.spm
intrude stolen - read ''
sees_nothing 'revoked keys'
wait_for_line publish.log 'certificate revoked'
intrude_until "^catalogue $samples" "$other" - read ''
stop_publisher

# A restarted server has the same certificate and counts as the same one, without --failover.
scene bumpy.gltf 'toy bumpy 0'
start_publisher bumpy.gltf --scene toy --watch
expect 2 'is not shown' "$hrtc" --domain "$domain" --scene "toy@$(uname -n)" --allow-no-rt \
    --wait 2 "${controller_security[@]}"
start_hrtc --scene toy@station --device sim:touch --duration 600 --wait "$patience_s" \
    --report report.json
wait_for_contact publish.log hand-1
stop KILL "$publisher"
wait_for_line hrtc.log "the server of scene 'toy', spm_publish"
start_publisher bumpy.gltf --scene toy --watch
wait_for_line hrtc.log "scene 'toy' now follows spm_publish"
wait_for_contact publish.log hand-1
stop_hrtc
grep -q "scene 'toy' now follows spm_publish (process $publisher on .*, cert:[0-9a-f]\{12\})" \
    hrtc.log || fault 'the line names no certificate'
check report.json servers.lost == 1 servers.replaced == 1 servers.not_followed == 0
stop_publisher
finish
