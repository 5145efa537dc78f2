#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# one_command.sh: tactus runs each program as if by its own name; tactus touch builds a mesh's model
# once, notices a damaged one, and leaves no process.
source "$(dirname "$0")/common.sh"
readonly bin=$1 view=$1/spm_view

# refuse CODE LINE ARGUMENT...: expects that exit code of tactus, and LINE as the only output.
refuse() {
    local wanted=$1 line=$2 code=0 output
    output=$("$tactus" "${@:3}" 2>&1 </dev/null) || code=$?
    [[ $code == "$wanted" && "$output" == "$line" ]] \
        || fault "tactus ${*:3}: expected exit $wanted and: $line; got exit $code and: $output"
}

# is_same PROGRAM [ARGUMENT] COMMAND ARGUMENT...: both end with the same code and output.
is_same() {
    local code=0 other=0
    "$tactus" "$1" "${@:3}" >by_command.txt 2>&1 || code=$?
    # shellcheck disable=SC2086 # A program and its first argument.
    "$bin"/$2 "${@:3}" >by_name.txt 2>&1 || other=$?
    if ((code != other)) || ! cmp -s by_command.txt by_name.txt; then
        fault "tactus $1 ${*:3}: exit $code, not $other: $(diff by_command.txt by_name.txt)"
    fi
}

# --- one name for the programs -------------------------------------------------------------------

model bumpy-sphere-20000 ball.spm
while IFS='|' read -r command program; do
    is_same "$command" "$program" --help
    is_same "$command" "$program" --no-such-option
    is_same "$command" "$program" 'two words' ''
done <<'COMMANDS'
build|spm_build
inspect|spm_inspect
serve|spm_publish
view|spm_view
run|hrtc
doctor|hrtc doctor
COMMANDS
is_same inspect spm_inspect ball.spm --json
is_same run hrtc ball.spm --virtual-time --duration 1 --tool sphere:0.003
grep -q '^verdict ' by_command.txt || fault "nothing was touched: $(<by_command.txt)"

refuse 3 'tactus: a command is missing; see --help'
refuse 3 "tactus: 'buidl': no command is called so; build?" buidl ball.spm
refuse 3 "tactus: 'tuch': no command is called so; touch?" tuch
refuse 3 "tactus: 'xyzzy': no command is called so; see --help" xyzzy
refuse 3 "tactus: 'a?b': no command is called so; see --help" $'a\nb'
refuse 3 'tactus: --verzion: no option is called so; --version?' --verzion
"$tactus" help >help.txt || fault 'no help'
for command in touch build inspect serve view run doctor; do
    grep -q "^  tactus $command " help.txt || fault "--help lacks $command"
done

# --- touch ---------------------------------------------------------------------------------------

mkdir work cache
export XDG_CACHE_HOME=$PWD/cache
"$inspect" ball.spm --extract --faces 2000 -o work/statue.obj >/dev/null
# touch ARGUMENT...: a short successful run without a view; its output is in touch.log.
touch_mesh() {
    "$tactus" touch --no-view --duration 1 "$@" >touch.log 2>&1 || fault "$*: $(<touch.log)"
}
# models: prints the models in the cache beside the mesh.
models() { find work/.tactus -name statue.spm; }

touch_mesh work/statue.obj --unit cm
grep -q '^diagonal 0.00[0-9]* m, a unit of the mesh is 0.01 m;' touch.log || fault 'another unit'
grep -q '^frames      1000 at 1000 Hz' touch.log || fault "no second: $(<touch.log)"
grep -qi '<!doctype html>' statue.report.html || fault 'no report'
made=$(models)
[[ -f "$made" ]] || fail "not one model: $made"
"$build" work/statue.obj --unit cm -o by_hand.spm >/dev/null 2>&1
cmp "$made" by_hand.spm || fault 'not the model of spm_build'
before=$(stat -c '%i %Y' "$made")

touch_mesh work/statue.obj --unit cm --report run.json -- --pool-mib 3
grep -qx "model       $made, built before" touch.log || fault "built twice: $(<touch.log)"
check run.json frames == 1000 force.max_n '>' 0
[[ $(stat -c '%i %Y' "$made") == "$before" ]] || fault 'the model in the cache changed'

# Every byte counts, also one of a chunk.
chunk=$(($(stat -c %s "$made") - 3000))
printf 'damaged' | dd of="$made" bs=1 seek="$chunk" conv=notrunc 2>/dev/null
touch_mesh work/statue.obj --unit cm
grep -q "^tactus: $made: .*; building the model again\$" touch.log || fault "$(<touch.log)"
cmp "$made" by_hand.spm || fault 'the damaged model is still there'
: >"$made"
touch_mesh work/statue.obj --unit cm
cmp "$made" by_hand.spm || fault 'the empty model is still there'

# Other options, and other content under the same name, are other models.
touch_mesh work/statue.obj --unit mm
(($(models | wc -l) == 2)) || fault "other options: $(models)"
"$inspect" ball.spm --extract --faces 1000 -o work/statue.obj >/dev/null
touch_mesh work/statue.obj --unit mm
(($(models | wc -l) == 3)) || fault "other content: $(models)"
[[ -z $(ls cache) ]] || fault 'the second folder was used'

# A file where the folder would be stands for one that can't be written, which root always can.
rm -r work/.tactus
: >work/.tactus
touch_mesh work/statue.obj
made=$(find cache/tactus -name statue.spm)
[[ -f "$made" ]] || fault 'no model in the second folder'
touch_mesh work/statue.obj
grep -qx "model       $PWD/$made, built before" touch.log || fault "built twice: $(<touch.log)"
XDG_CACHE_HOME=/dev/null/none expect 2 'no folder for the model; work/.tactus: ' \
    "$tactus" touch work/statue.obj --no-view
rm work/.tactus

# A model needs no cache.
touch_mesh ball.spm
[[ ! -e .tactus ]] || fault 'a model was built of a model'

# --- bad input -----------------------------------------------------------------------------------

echo 'nonsense' >work/bad.obj
refuse 2 "$("$build" work/bad.obj -o bad.spm 2>&1)" touch work/bad.obj --no-view
[[ ! -e work/.tactus ]] || fault 'a bad mesh left a folder'
refuse 2 'tactus touch: work/none.obj: no such file' touch work/none.obj
refuse 3 'tactus touch: MESH is required; see --help' touch
refuse 3 'tactus touch: --untit: no option is called so; --unit?' touch work/statue.obj --untit mm
refuse 3 "tactus touch: MESH: 'a.glb' is a scene; build it with: tactus build a.glb -o FOLDER" \
    touch a.glb
refuse 3 "tactus touch: MESH: 'ball.spm' is a model; the options of meshes have no effect" \
    touch ball.spm --unit mm
refuse 3 "spm_build: --unit: 'furlong' is not mm, cm, m or in; see --help" \
    touch work/statue.obj --unit furlong
refuse 3 "hrtc: --stiffness: '0' is not a number in 1 .. 3000; see --help" \
    touch ball.spm --no-view --stiffness 0

# Alone, tactus names what it lacks.
mkdir alone
cp "$tactus" alone
expect 2 "$PWD/alone/hrtc: No such file or directory; the package tactus-controller has it" \
    alone/tactus run ball.spm
expect 2 "$PWD/alone/spm_build: No such file or directory; the package tactus-host has it" \
    alone/tactus touch work/statue.obj
[[ ! -e work/.tactus ]] || fault 'something was built for nothing'

# --- view ----------------------------------------------------------------------------------------

# processes: prints the programs that tactus has started here.
cp ball.spm "shown-$$.spm"
processes() { grep -lz -- "^shown-$$.spm" /proc/[0-9]*/cmdline 2>/dev/null; }
has_ended() { ! processes >/dev/null; }
if ! "$view" --domain "$domain" --port 0 --seconds 0.1 >view.log 2>&1; then
    echo "not tried: the view ($(tail -n 1 view.log))"
    finish
    exit 0
fi
for signal in TERM KILL; do
    "$tactus" touch "shown-$$.spm" --domain "$domain" --duration 3600 >touch.log 2>&1 &
    started+=("$!")
    wait_for_line touch.log "/ shows DDS domain $domain"
    wait_for_line touch.log 'touches     shown'
    stop "$signal" "$!"
    wait_until 'end of all programs' has_ended
    [[ $signal == KILL ]] || ((stopped_with == 0)) || fault "stopped: $(<touch.log)"
done
# The view ends with the run.
"$tactus" touch "shown-$$.spm" --domain "$domain" --duration 1 >touch.log 2>&1 \
    || fault "$(<touch.log)"
has_ended || fault "still there: $(processes)"
finish
