#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_bad_input.sh: any fault of models, files or the report's path gives the right exit code and
# one line that names it; no file is left half-written. HrtcOptions covers wrong options, and
# decoder laws faults within a file.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 good.spm
mkdir out

refuse() { expect "$1" "$2" "$hrtc" --allow-no-rt "${@:3}"; }
run_file() { timeout 30 "$hrtc" --allow-no-rt --transport file --model good.spm "$@"; }

# Resources that the machine or the network does not have.
(($(nproc --all) > 1023)) || refuse 3 '--cpu: *it may use' --model bumpy --cpu 1023
refuse 2 "model 'bumpy' is not published on domain $domain" --model bumpy --domain "$domain" \
    --wait 0.2

# Files.
bytes=$(stat -c %s good.spm)
printf 'solid of some other program\n' >foreign.spm
head -c $((bytes - 1)) good.spm >cut.spm
refuse_file() { refuse 2 "$1: $2" --transport file --model "$1"; }
refuse_file models/missing.spm 'cannot be opened: No such file or directory'
refuse_file out 'is not a file but a directory'
refuse_file foreign.spm 'is not an SPM model: it does not begin with the letters TACTSPM'
refuse_file cut.spm "has $((bytes - 1)) bytes, but its header states $bytes: the file is cut short"
refuse 2 'no?where.spm: cannot be opened' --transport file --model $'no\nwhere.spm'
refuse 2 'missing.gltf: no such file' missing.gltf
refuse 2 'missing.rec: cannot be opened' good.spm --device replay:missing.rec
refuse 2 'missing.so' good.spm --device "plugin:$PWD/missing.so"
refuse 2 "--motion: no object is called 'cow'; there are good" good.spm --motion tap:cow
refuse 2 '--pool-mib: 0.25 MiB is too small for 1 model; at least 0.38 MiB is needed' good.spm \
    --pool-mib 0.25
softest='0.01 N is 0.02 mm at a stiffness of 500 N/m, more than the radius'
refuse 2 "--force-tolerance: $softest of the tool sphere:0.00001; use 0 to 0.00495 N" good.spm \
    --tool sphere:0.00001 --force-tolerance 0.01

# Memory that nothing needs is neither taken nor locked.
if [[ -z "$sanitizer" ]]; then
    (ulimit -v 2000000 \
        && run_file --pool-mib 4096 --duration 0.5 --report most.json >hrtc.log 2>&1) \
        || { cat hrtc.log; fault 'it takes all of --pool-mib'; }
    check most.json frames == 500 pools.total_bytes '<' 20000000
fi

# An unwritable report is detected before the run.
start=$SECONDS
mkfifo pipe.json
mkdir folder.json
for path in nowhere/report.json folder.json good.spm/report.json pipe.json; do
    refuse 2 "$path" --transport file --model good.spm --duration 60 --report "$path"
done
((SECONDS - start < 30)) || fault 'it ran before it found out that it could not report'
[[ -z $(ls -A out)$(ls -A folder.json) && -p pipe.json && -z $(compgen -G '*partial*') ]] \
    || fault "left behind: $(ls -A . out)"

# A damaged chunk is refused on arrival; the run continues with sound ones, reports it, and fails
# with --strict.
"$inspect" good.spm --json >/dev/null
cp good.spm chunk.spm
printf '\xff\xfe\xfd' | dd of=chunk.spm bs=1 seek=$((bytes - 50)) conv=notrunc status=none
damaged() { # damaged CODE ARGUMENT...: expects that code and one line about the damage.
    local code=0
    "$hrtc" --virtual-time --transport file --model chunk.spm --duration 3 \
        --report out/report.json "${@:2}" >hrtc.log 2>&1 || code=$?
    ((code == $1)) || { cat hrtc.log; fault "a damaged chunk ended the run with $code"; }
    check out/report.json frames == 3000 models.0.pieces_refused == 1
    grep -q '^verdict .*1 damaged piece of chunk' hrtc.log || fault 'the verdict does not tell'
    [[ $(grep -c '^hrtc: chunk.spm: .*damaged' hrtc.log) == 1 ]] || fault 'it is not told once'
}
damaged 0
damaged 1 --strict
rm -f out/report.json

# A hand that is too fast gets no force, and the report gives the reason.
run_file --virtual-time --duration 2 --speed-limit 0.01 --report out/report.json >hrtc.log 2>&1 \
    || { cat hrtc.log; fault 'a run with a speed limit ended badly'; }
check out/report.json safety.begun.velocity '>' 0 safety.events '>' 2 \
    safety.events_left_out '>=' 0 safety.begun.garbage == 0 safety.begun.disconnect == 0 \
    safety.begun.software '<=' 1
grep -q '^safety .*velocity' hrtc.log || fault 'no word about the speed'
rm -f out/report.json

# A report in .html is a complete page with the run's figures.
run_file --duration 0.5 --report out/run.html --report out/report.json >hrtc.log 2>&1 \
    || fault 'no page'
[[ $(head -n 1 out/run.html) == '<!DOCTYPE html>' && $(tail -n 1 out/run.html) == '</html>' ]] \
    || fault 'the page is no page'
grep -qF "$(sed -n 's/^frames *//p' hrtc.log)" out/run.html || fault 'the page is of another run'
if command -v python3 >/dev/null; then
    python3 -c 'import sys, xml.etree.ElementTree as tree; tree.parse(sys.argv[1])' out/run.html \
        || fault 'the page is not well-formed'
fi
check out/report.json frames == 500
rm -f out/run.html out/report.json

# An interrupted run ends early and reports.
"$hrtc" --allow-no-rt --transport file --model good.spm --duration 60 --report out/report.json \
    >hrtc.log 2>&1 &
controller=$!
started+=("$controller")
wait_for_sleeps 100 "$controller"
stop INT "$controller"
((stopped_with == 0)) || fault "the interrupted run ended with $stopped_with"
check out/report.json frames '>' 0 frames '<' 10000
[[ $(ls -A out) == report.json ]] || fault "left behind: $(ls -A out)"
finish
