#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_doctor.sh: on any machine the doctor's exit code, text and JSON agree with each other and
# with the system; a DDS configuration that cannot be joined is critical; wrong options are refused.
source "$(dirname "$0")/common.sh"

# examine NAME [ARGUMENT...]: writes text and JSON to NAME.txt and NAME.json, which must agree; the
# exit code is in $ended_with.
examine() {
    local name=$1 verdict code=0
    shift
    ended_with=0
    "$hrtc" doctor --all "$@" >"$name.txt" 2>errors.txt || ended_with=$?
    "$hrtc" doctor --json "$@" >"$name.json" 2>>errors.txt || code=$?
    [[ ! -s errors.txt ]] || fault "doctor $*: $(cat errors.txt)"
    ((code == ended_with)) || fault "doctor $* ended with $ended_with and with --json $code"
    check "$name.json" schema == 1 checks == 17 \
        counts.good+counts.advice+counts.critical+counts.unknown == '1*checks'
    for verdict in good advice critical unknown; do
        check "$name.json" "counts.$verdict" == "$(grep -c "^$verdict " "$name.txt" || true)"
    done
    case $ended_with in
        0) check "$name.json" counts.critical == 0 ;;
        1) check "$name.json" counts.critical '>' 0 ;;
        *) fault "doctor $* ended with $ended_with" ;;
    esac
    ! LC_ALL=C grep -q '[^[:print:]]' "$name.txt" || fault "doctor $* prints more than text"
}

# The counts are first; good checks share one line.
"$hrtc" doctor >short.txt || true
[[ $(sed -n 1p short.txt) == *' critical, '*' good' ]] || fault "first: $(sed -n 1p short.txt)"
(($(grep -c '^good ' short.txt) == 1)) || fault 'more than one line is of what is good'

# verdict_of NAME CHECK: prints the verdict in the text.
verdict_of() { awk -v check="$2" '$2 == check { print $1 }' "$1.txt"; }

examine plain
cpu=$(taskset -cp $$ | sed 's/.*[ ,-]//')
examine pinned --cpu "$cpu"
check pinned.json cpu == "$cpu"

# Verdict of the system.
wanted=critical
! chrt -f 81 true 2>/dev/null || wanted=good
[[ $(verdict_of plain priority) == "$wanted" ]] || fault "priority is not $wanted"
wanted=advice
[[ $(uname -v) != *PREEMPT_RT* ]] || wanted=good
[[ $(verdict_of plain preemption) == "$wanted" ]] || fault "preemption is not $wanted"

# Participants on a domain, and published models; none at first.
domain_says() { # domain_says PATTERN: checks the 18th check.
    "$hrtc" doctor --domain "$domain" --wait 1 >domain.txt || true
    grep -A 3 -E "^(good|advice) +dds-domain" domain.txt | tr -s ' \n' ' ' | grep -q "$1"
}
domain_says "^advice dds-domain no program is heard on domain $domain within 1 s" \
    || fault "doctor --domain: $(cat domain.txt)"
model bumpy-sphere-5000 ball.spm
"$publish" ball.spm --domain "$domain" >publish.log 2>&1 &
started+=("$!")
wait_until 'word of the doctor on the server' domain_says \
    "^good dds-domain .*spm_publish (process $! on $(uname -n)).*models published: ball"
"$hrtc" doctor --json --domain "$domain" --wait 0.5 >domain.json || true
check domain.json checks == 18

# A critical DDS finding is a failure of hrtc.
readonly interface='<Interfaces><NetworkInterface name="nowhere0"/></Interfaces>'
for uri in "file://$scratch/missing.xml" \
    "<CycloneDDS><Domain><General>$interface</General></Domain></CycloneDDS>"; do
    export CYCLONEDDS_URI=$uri
    examine configured
    ((ended_with == 1)) || fault "doctor with $uri ended with $ended_with"
    grep -q '^critical  *dds-' configured.txt || fault "no word about $uri"
    code=0
    "$hrtc" --allow-no-rt --plain --model bumpy --domain "$domain" --wait 1 >hrtc.log 2>&1 \
        || code=$?
    if ((code != 2)) || ! grep -q 'cannot be joined' hrtc.log; then
        cat hrtc.log
        fault "hrtc itself ended with $code"
    fi
    unset CYCLONEDDS_URI
done

# The command line.
refuse() { expect 3 "$1" "$hrtc" doctor "${@:2}"; } # refuse PATTERN ARGUMENT...
for value in -1 1024 all 1.5 ''; do
    refuse '--cpu: *0 .. 1023' --cpu "$value"
done
refuse --cpu --cpu
(($(nproc --all) > 1023)) || refuse 'it may use' --cpu 1023
refuse --fast --fast
refuse extra extra
"$hrtc" doctor --help >help.txt || fault 'hrtc doctor --help'
grep -q -- --json help.txt || fault 'hrtc doctor --help'
# No pipe: grep exits at the first match, and further writes then fail.
"$hrtc" --help >help.txt
grep -q 'hrtc doctor' help.txt || fault 'hrtc --help does not tell of the doctor'
expect 3 doctor "$hrtc" --allow-no-rt doctor # Accepted only as the first word.
code=0
"$hrtc" doctor >/dev/full 2>full.txt || code=$?
((code == 2)) || fault "with a full disk doctor ended with $code"
finish
