#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_record_and_replay.sh: a run over DDS with governed budgets is recorded and replays bit for
# bit without DDS; another input is reported with its frame; damaged and foreign files, and options
# that exclude each other, are refused in one line. $4 is the program that alters a recording.
here=$(cd "$(dirname "$0")" && pwd)
readonly here
source "$here/common.sh"
readonly alter=$4

# The command line, before anything runs.
refuse() { expect "$1" "$2" "$hrtc" "${@:3}"; }
"$hrtc" --help >help.txt
for option in --record --replay --export --trace --histograms; do
    grep -q -- "$option " help.txt || fault "hrtc --help does not tell of $option"
    [[ $option == --export ]] || refuse 3 "$option: *name is empty" --model bumpy "$option" ''
done
refuse 3 'a model is required' --record run.rec
readonly only='--replay: takes only --kernels, --export, --log-level and --json-log'
for option in '--model a' '--record a' '--duration 1' '--rate 1000' '--frame-budget-us 100' \
    '--splits 100' '--report a.json'; do
    # shellcheck disable=SC2086 # An option and its value.
    refuse 3 "$only; ${option% *} was given" --replay run.rec $option
done
refuse 3 "$only; --allow-no-rt was given" --replay run.rec --allow-no-rt
refuse 3 '--record: must be another file than --report' \
    --model bumpy --record a.json --report a.json
refuse 3 '--export: needs --replay' --model bumpy --export a.csv
refuse 3 "--export: 'a.xml' must end in .csv, .jsonl or .mcap" --replay a --export a.xml
refuse 3 "--export: 'a.csv' is given twice" --replay a --export a.csv --export a.csv
refuse 3 '--export: must be another file than --replay' --replay a.csv --export a.csv
for option in --trace --histograms; do
    refuse 3 "--virtual-time: $option would have no times" \
        --transport file --model a.spm --virtual-time "$option" a
done
refuse 3 '--trace: must be another file than --record' --model a --record a --trace a
refuse 3 '--trace: must be another file than --report' --model a --report a.json --trace a.json
refuse 2 "--trace: nowhere/a: can't be written" --allow-no-rt --model a --trace nowhere/a
refuse 2 "--histograms: nowhere/frame.hgrm: can't be written" --allow-no-rt --model a \
    --histograms nowhere
mkdir folder
for path in nowhere/run.rec folder; do
    refuse 2 "--record: $path: can't be written" --allow-no-rt --model bumpy --record "$path"
done

# Two tools, two models, streaming into small pools.
model bumpy-sphere-60000 bumpy.spm
model torus-20000 torus.spm
start_publisher bumpy.spm torus.spm
mkdir times
contact=0 run_hrtc --model bumpy --model torus --place 0,0,0 --place 0.3,0,0,0,30,0,2 \
    --material 300,0.4,0.3,0.5 --tool sphere:0.002 --tool sphere:0.004 --duration 2 \
    --pool-mib 1.25 --frame-budget-us 300 --predict quadratic --record run.rec \
    --trace run.trace --histograms times
check_clean report.json
check report.json frames == 2000 recording.frames == 2000 recording.bytes '>' 100000
grep -q '"prediction": *"quadratic"' report.json || fault 'the report tells of another prediction'
grep -q '^recording   2000 frames, ' hrtc.log || fault 'the summary has no recording'
! grep -q 'incomplete' hrtc.log || fault 'frames of the recording are lost'
python3 "$here/read_trace.py" run.trace report.json || fault 'the trace, see above'
for time in load refine refit query force frame cpu wake response; do
    grep -Eq '^#\[Max +=.*, Total count += +[0-9]+\]$' "times/$time.hgrm" \
        || fault "times/$time.hgrm"
done
grep -Eq '^#\[Max +=.*, Total count += +2000\]$' times/frame.hgrm || fault 'not each frame counts'
[[ -z $(compgen -G '*.partial' times/*.partial) ]] || fault 'left behind: a partial file'
stop_publisher

said=$("$hrtc" --replay run.rec) || fail "the replay ended with $?: $said"
[[ "$said" == 'run.rec: 2000 frames agree bit for bit; recorded by '* ]] || fault "it says: $said"

# The same with portable and with unknown kernels.
said=$("$hrtc" --replay run.rec --kernels portable) || fail "portable: ended with $?: $said"
[[ "$said" == 'run.rec: 2000 frames agree bit for bit; '* ]] || fault "portable: it says: $said"
for kind in --replay --model; do
    refuse 3 "--kernels: 'sse' is not one of the kernels for this processor: portable" \
        "$kind" run.rec --kernels sse
done

# Export for other tools, read by our own readers.
"$hrtc" --replay run.rec --export run.csv --export run.jsonl --export run.mcap >said.txt \
    || fail "the export ended with $?"
grep -qx 'export      run.mcap' said.txt || fault "it says: $(<said.txt)"
python3 "$here/read_exports.py" run 2000 report.json || fault 'the exports, see above'
refuse 2 "--export: nowhere/a.csv: can't be written" --replay run.rec --export nowhere/a.csv
code=0
(
    trap '' XFSZ
    ulimit -f 64
    exec "$hrtc" --replay run.rec --export folder/a.mcap
) >said.txt 2>&1 || code=$?
if ((code != 2)) || ! grep -q "^hrtc: --export: folder/a.mcap: can't be written: File" \
    said.txt; then
    fault "an export that could not be stored ended with $code: $(<said.txt)"
fi
"$alter" run.rec altered.rec 1234
code=0
"$hrtc" --replay altered.rec --export folder/a.csv >said.txt 2>&1 || code=$?
((code == 1)) || fault "the export of a replay that differs ended with $code"
[[ -z $(ls -A folder) ]] || fault "an export was left behind: $(ls -A folder)"

# Truncated copy: the complete part is replayed, exported and played by a device.
head -c $(($(stat -c %s run.rec) - 100)) run.rec >cut.rec
"$hrtc" --replay cut.rec --export cut.csv >said.txt 2>&1 || fault "a cut recording: $(<said.txt)"
grep -q 'cut.rec: [0-9]* frames agree .*; the file is incomplete: after frame ' said.txt \
    || fault "a cut recording is not said to be one: $(<said.txt)"
frames=$(grep -o '[0-9]* frames agree' said.txt)
(($(wc -l <cut.csv) == ${frames%% *} + 1)) || fault 'not every whole frame was exported'
"$hrtc" --allow-no-rt --virtual-time --transport file --model bumpy.spm --duration 0.5 \
    --device replay:cut.rec >said.txt 2>&1 || fault "a cut recording as a device: $(<said.txt)"
grep -q 'cut.rec: the file is incomplete: after frame ' said.txt \
    || fault "a device's recording is not said to be cut: $(<said.txt)"

# One bit of one input.
for frame in 0 1234; do
    "$alter" run.rec altered.rec "$frame"
    refuse 1 "altered.rec: frame $frame differs: " --replay altered.rec
done

# Files that are no recording, or not complete. The line names file, byte and allowed values.
: >empty.rec
head -c 5 run.rec >five.rec
head -c 4000 run.rec >start.rec
{ cat run.rec; printf x; } >long.rec
cp run.rec bent.rec
printf '\xff\xfe' | dd of=bent.rec bs=1 seek=3000 conv=notrunc status=none # Inside the first model.
cp run.rec newer.rec
printf '\xff' | dd of=newer.rec bs=1 seek=8 conv=notrunc status=none
refuse_file() { refuse 2 "$1: $2" --replay "$1"; }
refuse_file missing.rec 'cannot be opened'
refuse_file folder 'is not a file but a directory'
refuse_file empty.rec 'at byte 0: the file is empty'
refuse_file bumpy.spm 'at byte 0: is not a Tactus recording'
refuse_file five.rec \
    'at byte 0: the file is cut short: 12 bytes are needed at this point, but 5 are left'
refuse_file start.rec 'at byte *: the file is cut short: no frame is complete'
refuse_file long.rec 'at byte *: 1 byte after the end section, which must be the last'
refuse_file bent.rec 'at byte *: section of kind 2 and * bytes is damaged: its checksum'
refuse_file newer.rec 'at byte 8: format version 255 is unknown; this program reads 12'
refuse 2 'no?where.rec: cannot be opened' --replay $'no\nwhere.rec'

# A recording that cannot be stored does not disturb the run, and is reported at its end.
code=0
( # Files of at most 64 KiB, without the signal that would end the program.
    trap '' XFSZ
    ulimit -f 64
    exec "$hrtc" --allow-no-rt --transport file --model bumpy.spm --duration 1 --report full.json \
        --record folder/run.rec
) >hrtc.log 2>&1 || code=$?
((code == 2)) || fault "a recording that could not be stored ended the run with $code"
grep -q "^hrtc: --record: folder/run.rec: can't be written: File too large" hrtc.log \
    || fault 'a recording that could not be stored is not told'
[[ -z $(ls -A folder) ]] || fault "left behind: $(ls -A folder)"
check full.json frames == 1000

# An interrupted run has recorded its frames so far.
start_hrtc --transport file --model bumpy.spm --duration 600 --record short.rec
wait_for_line hrtc.log 'touch: '
wait_for_sleeps 1000 "$controller"
stop INT "$controller"
((stopped_with == 0)) || fault "the interrupted run ended with $stopped_with"
"$hrtc" --replay short.rec >said.txt || fault 'the interrupted run does not replay'
cat said.txt
finish
