#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# wrong_usages.sh: wrong usage of each kind and program ends it with its code and one line on
# stderr; nothing is left behind. HrtcOptions and ServerOptions cover further wrong usage.
source "$(dirname "$0")/common.sh"
readonly view=$1/spm_view
: >mesh.obj
printf 'model = "ball.spm"\n\nrate = "1k"\n' >number.toml
: >output.txt
: >said.txt
before=$(ls -A)

# refuse CODE LINE PROGRAM ARGUMENT...: expects that code, and LINE as the only output.
refuse() {
    local wanted=$1 line=$2 code=0
    shift 2
    "$@" >output.txt 2>said.txt </dev/null || code=$?
    if ((code != wanted)) || [[ $(<said.txt) != "$line" || -s output.txt ]]; then
        printf '%s\n  expected exit %d and: %s\n  got exit %d, on stdout and stderr:\n%s\n%s\n' \
            "$*" "$wanted" "$line" "$code" "$(<output.txt)" "$(<said.txt)"
        failures=$((failures + 1))
    fi
}

readonly missing='a model is required: hrtc FILE.spm, or --model NAME for a published model'
refuse 3 "hrtc: $missing; see --help" "$hrtc"
refuse 3 "hrtc deadline-test: $missing; see --help" "$hrtc" deadline-test
refuse 3 'hrtc doctor: --wait requires --domain; see --help' "$hrtc" doctor --wait 1
refuse 3 "hrtc load: KIND: 'gpu' is not cpu, memory or disk; see --help" "$hrtc" load gpu
refuse 3 'hrtc: --stifness: no option is called so; --stiffness?' "$hrtc" ball.spm --stifness=300
refuse 3 'hrtc: --report: a value is missing; see --help' "$hrtc" ball.spm --report --strict
refuse 3 'hrtc: --cache-mib: must be less than --pool-mib' "$hrtc" ball.spm --cache-mib 3
refuse 3 "hrtc: number.toml:3: --rate: '...' is not a whole number in 100 .. 10000; see --help" \
    "$hrtc" --config number.toml
refuse 2 "hrtc: --config: missing.toml: no such file" "$hrtc" --config missing.toml

refuse 3 'spm_build: --output is required; see --help' "$build" mesh.obj
refuse 3 'spm_build: --unit excludes --fit-diag; see --help' \
    "$build" mesh.obj --unit mm --fit-diag 0.2 -o a.spm
refuse 3 "spm_build: --output: 'a.stl' must end in .spm" \
    "$build" mesh.obj -o a.stl
refuse 3 'spm_build: --output: a glTF scene needs a folder for its models, not an .spm file' \
    "$build" scene.gltf -o made.spm
refuse 3 "spm_inspect: 'ball.spm': nothing takes this word; see --help" \
    "$inspect" ball.spm ball.spm
refuse 3 "spm_inspect: FILE: 'mesh.obj' is a mesh; build a model with: spm_build mesh.obj -o \
MODEL.spm" "$inspect" mesh.obj
refuse 3 'spm_inspect: --extract needs --faces, --error or --region; see --help' \
    "$inspect" ball.spm --extract -o a.ply
refuse 3 "spm_publish: --domain: '233' is not a whole number in 0 .. 232; see --help" \
    "$publish" ball.spm --domain 233
refuse 3 'spm_publish: --domain: is given twice; see --help' \
    "$publish" ball.spm --domain 1 --domain 2
refuse 3 "spm_publish: --name 'a?b' is not 1 to 63 bytes of letters, digits, . _ -" \
    "$publish" ball.spm --name $'a\nb'
refuse 3 'spm_view: --domain excludes --replay; see --help' "$view" --replay a.rec --domain 3
refuse 3 'spm_view: --replay: 3 recordings; at most 2 can be compared' \
    "$view" --replay a --replay b --replay c

# Each line on stderr is one JSON object with --json-log.
logged() { # logged LEVEL CODE TEXT PROGRAM ARGUMENT...
    local code=0
    "${@:4}" --json-log 2>said.txt >output.txt </dev/null || code=$?
    (($2 == code)) || fault "$4 --json-log ended with $code"
    printf '%s\t%s\t%s\t%s\n' "$(basename "$4")" "$1" "$3" "$(<said.txt)" >>logged.txt
}
logged error 2 'missing.ply' "$build" missing.ply -o a.spm
logged info 0 'note: ' "$build" --shape torus --faces 1001 -o big.spm
logged error 2 $'caf\xC3\xA9 "?"' "$inspect" $'caf\xC3\xA9 "\n"'
logged error 2 'missing.spm' "$publish" missing.spm --log-level error
logged error 3 "--rate: '5'" "$hrtc" --model ball.spm --rate 5
logged error 2 'missing.rec' "$hrtc" --replay missing.rec
logged error 2 'missing.spm' "$view" missing.spm
python3 - <<'PYTHON' || fault "--json-log: $(<logged.txt)"
import datetime
import json

with open("logged.txt", encoding="utf-8") as file:
    lines = file.read().splitlines()
assert len(lines) == 7
for line in lines:
    program, level, text, said = line.split("\t")
    told = json.loads(said)
    assert list(told) == ["time", "level", "program", "text"], line
    assert (told["program"], told["level"]) == (program, level) and text in told["text"], line
    age = datetime.datetime.now(datetime.timezone.utc) - datetime.datetime.fromisoformat(
        told["time"].replace("Z", "+00:00"))
    assert abs(age) < datetime.timedelta(hours=1), line
PYTHON
[[ -z $("$build" --shape torus --faces 1001 -o big.spm --log-level warning 2>&1 >/dev/null) ]] \
    || fault 'a note is told that was not to be'
[[ $("$hrtc" help) == *'Each command has its own --help.' ]] || fault 'hrtc help'
rm -f logged.txt big.spm
[[ $(ls -A) == "$before" ]] || fault "left behind: $(ls -A)"
finish
