#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# wrong_usages.sh: each line of wrong_usages.txt beside it ends with its code, and says in one line
# what it has to; nothing is left behind but what the last ones are meant to write.
here=$(cd "$(dirname "$0")" && pwd)
readonly here
source "$here/common.sh"
model bumpy-sphere-5000 ball.spm
mkdir folder models
printf 'v 0 0 0\nv 200 0 0\nv 0 200 0\nf 1 2 3\n' >mesh.obj
: >empty.obj
printf 'no model at all\n' >prose.spm
bytes=$(stat -c %s ball.spm)
head -c $((bytes - 1)) ball.spm >cut.spm
cp ball.spm flip.spm
printf '\xff\xfe\xfd' | dd of=flip.spm bs=1 seek=$((bytes - 50)) conv=notrunc status=none
printf 'model = "ball.spm"\nstifness = 300\n' >unknown.toml
printf '[loop]\nrate = 1000\n' >section.toml
printf 'model: ball.spm\n' >yaml.toml
printf '# Mine.\nmodel = [\n' >list.toml
printf 'model = "ball.spm"\n\nrate = "1k"\n' >number.toml
printf 'model = "ball.spm"\ndevice = "udp:80"\n' >device.toml
printf '0 ball 0 0 0 0 0 0 1\n1 horse 0 0 0 0 0 0 1\n' >other.txt
printf '1 ball 0 0 0 0 0 0 1\n0 ball 0 0 0 0 0 0 1\n' >order.txt
printf '0 ball 0 0 0 0 0 0 2\n' >turned.txt
printf 'one two three\n' >words.txt
before=$(ls -A)

# judge CODE TEXT WORD...: the program that the first word names, with the others.
judge() {
    local wanted=$1 text=$2 name=$3 code=0 output=''
    shift 3
    local command=("$(dirname "$hrtc")/$name")
    # As on any machine, on a domain of this test's.
    if [[ $name == hrtc && " $* " != *' '@(doctor|--doctor|load|help|--replay)' '* ]]; then
        [[ ${1:-} != deadline-test ]] || { command+=("$1"); shift; }
        command+=(--allow-no-rt)
        [[ "$*" == *--domain* ]] || command+=(--domain "$domain")
    elif [[ $name == spm_publish ]]; then
        [[ "$*" == *--domain* ]] || set -- "$@" --domain "$domain"
        [[ "$*" == *@(--seconds|--duration)* ]] || set -- "$@" --seconds 5
    fi
    output=$("${command[@]}" "$@" 2>&1 </dev/null) || code=$?
    if ((code != wanted)) || [[ "$output" != *"$text"* ]] \
        || { ((wanted > 1)) && [[ "$output" != "$name"*": "* || "$output" == *$'\n'* ]]; }; then
        printf '%s %s\n  expected exit %d and "%s"\n  got exit %d and:\n%s\n' \
            "$name" "$*" "$wanted" "$text" "$code" "${output:0:1000}"
        failures=$((failures + 1))
    fi
}

lines=0
while IFS= read -r line; do
    [[ -n "$line" && "$line" != '#'* ]] || continue
    code=${line%% | *}
    line=${line#* | }
    read -ra words <<<"${line%% | *}"
    judge "$code" "${line#* | }" "${words[@]}"
    lines=$((lines + 1))
done <"$here/wrong_usages.txt"
((lines >= 107)) || fault "only $lines wrong usages"

# logged NAME LEVEL CODE TEXT WORD...: with --json-log its one line on stderr is such an object.
logged() {
    local name=$1 level=$2 wanted=$3 text=$4 code=0
    shift 4
    "$(dirname "$hrtc")/$name" "$@" --json-log 2>stderr.txt >/dev/null </dev/null || code=$?
    ((code == wanted)) || fault "$name --json-log ended with $code"
    python3 - "$name" "$level" "$text" <<'PYTHON' || fault "$name --json-log: $(<stderr.txt)"
import datetime
import json
import sys

(line,) = open("stderr.txt", encoding="utf-8").read().splitlines()
told = json.loads(line)
assert list(told) == ["time", "level", "program", "text"]
assert (told["program"], told["level"]) == tuple(sys.argv[1:3]) and sys.argv[3] in told["text"]
age = datetime.datetime.now(datetime.timezone.utc) - datetime.datetime.fromisoformat(
    told["time"].replace("Z", "+00:00"))
assert abs(age) < datetime.timedelta(hours=1)
PYTHON
}
logged spm_build error 2 'missing.ply' $'missing.ply' -o a.spm
logged spm_build info 0 'note: ' --shape torus --faces 1001 -o big.spm
logged spm_inspect error 2 $'caf\xC3\xA9 "?"' $'caf\xC3\xA9 "\n"'
logged spm_publish error 2 'missing.spm' missing.spm --log-level error
logged hrtc error 3 "--rate: '5'" --model ball.spm --rate 5
logged hrtc error 2 'missing.rec' --replay missing.rec
logged spm_view error 2 'missing.spm' missing.spm
judge 3 "--log-level: 'loud' is not error, warning or info" spm_inspect ball.spm --log-level loud
[[ -z $("$build" --shape torus --faces 1001 -o big.spm --log-level warning 2>&1 >/dev/null) ]] \
    || fault 'a note is told that was not to be'
rm -f stderr.txt
rm -f big.spm
[[ $(ls -A) == "$before" ]] || fault "left behind: $(ls -A)"
echo "$lines wrong usages"
finish
