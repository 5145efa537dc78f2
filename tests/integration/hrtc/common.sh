# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2034 # The scripts use what is set here.
# Functions of this folder's scripts; sourced with "$@" being BIN CHECK_REPORT SANITIZER: the folder
# of the programs, the report checker, and the build's -fsanitize=, or none. Enters a new folder
# that is removed at the end together with every process that was started here.
set -euo pipefail
readonly build=$1/spm_build inspect=$1/spm_inspect publish=$1/spm_publish hrtc=$1/hrtc
readonly keys=$1/tactus-keys tactus=$1/tactus
readonly check_report=$2 sanitizer=${3#none}
checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
readonly checkout
# A separate domain on loopback: no foreign models, and none of ours on a real interface.
readonly domain=${TACTUS_TEST_DOMAIN:-$(($$ % 231))}
unset CYCLONEDDS_URI
# Prefixes that start the programs of either side, set by two_networks.sh.
on_server=()
on_controller=()
# Options of security of either side, set by use_keys or two_networks.sh.
server_security=()
controller_security=()

scratch=$(mktemp -d)
started=() # Ids of the background processes.
leave() {
    local id
    for id in "${started[@]}"; do
        kill -KILL "$id" 2>/dev/null || true
        wait "$id" 2>/dev/null || true # Otherwise bash reports the kill.
    done
    rm -rf "$scratch"
}
trap leave EXIT
cd "$scratch"

# model SHAPE-FACES FILE: copies the model of make_models.sh if it exists, otherwise makes it.
model() {
    local made=${TACTUS_TEST_MODELS:-}/$1.spm
    if [[ -f "$made" ]]; then
        cp "$made" "$2"
    else
        "$build" --shape "${1%-*}" --faces "${1##*-}" -o "$2" >build.log 2>&1
    fi
}

# scene FILE "NAME MODEL X [Y]"...: writes a scene of objects that show MODEL.spm.
scene() {
    local file=$1 nodes='' list='' i=0 name model x y
    shift
    while read -r name model x y; do
        list+="${list:+, }$i"
        nodes+="${nodes:+, }{\"name\": \"$name\", \"translation\": [$x, ${y:-0}, 0],"
        nodes+=" \"extras\": {\"tactus\": {\"model\": \"$model.spm\"}}}"
        i=$((i + 1))
    done < <(printf '%s\n' "$@")
    printf '{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [%s]}], "nodes": [%s]}' \
        "$list" "$nodes" >"$file"
}

failures=0
fault() {
    printf 'FAULT: %s\n' "$*"
    failures=$((failures + 1))
}
fail() {
    fault "$@"
    exit 1
}
finish() { ((failures == 0)) || fail "$failures faults in all"; }

# expect CODE PATTERN PROGRAM ARGUMENT...: expects that exit code, and exactly one line, which
# begins with the program's name, optionally a subcommand's, and matches PATTERN.
expect() {
    local code=0 wanted=$1 pattern=$2 output name
    shift 2
    output=$("$@" 2>&1) || code=$?
    name=$(basename "$1")
    [[ "$output" != "$name ${2:-}: "* ]] || name+=" $2"
    if ((code != wanted)) || [[ "$output" != "$name: "*$pattern* ]] \
        || [[ "$output" == *$'\n'* ]] || [[ "$output" == *[$'\x01'-$'\x1f']* ]]; then
        printf '%q ' "${@:1:30}"
        printf '\n  expected exit %d and one line with "%s"\n  got exit %d and:\n%s\n' \
            "$wanted" "$pattern" "$code" "${output:0:2000}"
        failures=$((failures + 1))
    fi
}

# expect_found CODE PATTERN ARGUMENT...: the same for an hrtc that first discovers the domain, which
# gets more time.
expect_found() {
    local code=$1 pattern=$2 wait_s
    shift 2
    for wait_s in 0.5 5 "$patience_s"; do
        is_as_expected "$code" "$pattern" "$hrtc" --allow-no-rt --domain "$domain" \
            --wait "$wait_s" "$@" && return
    done
    fault "$(cat expected.log)"
}
is_as_expected() {
    local failures=0
    expect "$@" >expected.log
    ((failures == 0))
}

# Waits are for events. The limit detects missing ones and exceeds the delays of any machine.
readonly patience_s=150

# wait_until WHAT COMMAND...: waits for success of the command; names WHAT otherwise.
wait_until() {
    local what=$1 end=$((SECONDS + patience_s))
    shift
    until "$@"; do
        ((SECONDS < end)) || fail "no $what after $patience_s s: $(tail -n 20 ./*.log)"
        sleep 0.05
    done
}

# lines TEXT FILE: prints the number of lines that contain it.
lines() { grep -csF -- "$1" "$2" || true; }
# lines_of_server MODEL FILE: prints the number of lines about the model's server; on a slow machine
# or a bad network others name missing pieces.
lines_of_server() { grep -sF -- "model '$1'" "$2" | grep -vcF ': chunk ' || true; }
has_lines() { (($(lines "$1" "$2") >= $3)); }

# wait_for_line FILE TEXT [COUNT]: waits for at least this number of lines with the text, by default
# one.
wait_for_line() { wait_until "'$2' in $1" has_lines "$2" "$1" "${3:-1}"; }

# frames_in FILE [NAME]: prints the frames of a controller, or of NAME, in the last line of the
# server with --watch whose output is in FILE. It prints once a second.
frames_in() {
    awk -v name="${2:-}" '
        $1 == "watch" && (name == "" || $2 == name ":") && $3 > most { most = $3 + 0 }
        END { print most + 0 }' "$1"
}
has_frames() { (($(frames_in "$2" "${3:-}") >= $1)); }

# wait_for_frames COUNT FILE [NAME]: waits until that number is printed there.
wait_for_frames() { wait_until "controller with $1 frames in $2" has_frames "$@"; }

# wait_for_more_frames COUNT FILE [NAME]: waits for that number of frames from now on.
wait_for_more_frames() {
    wait_for_frames $(($(frames_in "${@:2}") + 1)) "${@:2}"
    wait_for_frames $(($(frames_in "${@:2}") + $1)) "${@:2}"
}

# wait_for_contact FILE [NAME]: waits until that controller is printed as touching.
wait_for_contact() {
    wait_until "contact in $1" grep -Eqs "^watch ${2:-[^ ]*}: .* N in contact" "$1"
}

# wait_for_sleeps COUNT ID: waits until a thread of that process has slept this often. One of hrtc's
# does so up to three times a millisecond.
wait_for_sleeps() { wait_until "thread of process $2 that slept $1 times" has_slept "$@"; }
has_slept() { (($(sleeps_of "$2") >= $1)); }
sleeps_of() {
    awk '$1 == "voluntary_ctxt_switches:" && $2 > most { most = $2 } END { print most + 0 }' \
        "/proc/$1/task/"*/status 2>/dev/null
}
# resident_kib ID, memory_kib ID: print the process's resident memory, now and at most so far.
resident_kib() { awk '$1 == "VmRSS:" { print $2 }' "/proc/$1/status"; }
memory_kib() { awk '$1 == "VmHWM:" { print $2 }' "/proc/$1/status"; }

# wait_for_more ID [SLEEPS]: lets that process continue for this time, an hrtc for a second.
wait_for_more() { wait_for_sleeps $(($(sleeps_of "$1") + ${2:-3000})) "$1"; }

# skip_without_plugins: ends the script where Cyclone DDS has no plugins of DDS Security.
skip_without_plugins() {
    [[ -z "$(find /usr/lib -name libdds_security_auth.so -print -quit)" ]] || return 0
    echo 'skipped: Cyclone DDS is here without its security plugins'
    exit 77
}

# use_keys: programs started after this call have keys: servers are `station`, controllers `hand-1`.
# Keys of `hand-2`, of `desk`, a viewer, and of two editors lie beside them in machines/.
use_keys() {
    skip_without_plugins
    "$keys" --domain "$domain" --servers station --controllers hand-1 hand-2 --viewers desk \
        --editors editor-1 editor-2 >keys.log 2>&1 || fail "the keys: $(cat keys.log)"
    server_security=(--security "$PWD/machines/station")
    controller_security=(--security "$PWD/machines/hand-1")
}

# start_publisher ARGUMENT...: returns when it is ready; its id is in $publisher, its output in
# publish.log.
start_publisher() {
    : >publish.log
    "${on_server[@]}" "$publish" --domain "$domain" "${server_security[@]}" "$@" \
        >publish.log 2>&1 &
    publisher=$!
    started+=("$publisher")
    wait_for_line publish.log 'ready on DDS domain'
}

# stop SIGNAL ID: waits until the process is gone; its exit code is in $stopped_with.
stop() {
    stopped_with=0
    kill -"$1" "$2" || fail "process $2 had ended before it was stopped"
    wait "$2" 2>/dev/null || stopped_with=$?
}
# stop_publisher: ends the last one started, which must end well.
stop_publisher() {
    stop TERM "$publisher"
    ((stopped_with == 0)) || fault "spm_publish ended with $stopped_with: $(cat publish.log)"
}

# start_hrtc ARGUMENT...: starts it in the background; its id is in $controller, its output in
# hrtc.log.
start_hrtc() {
    local log
    exec {log}>hrtc.log # Here, so that the caller may move it at once.
    "${on_controller[@]}" "$hrtc" --allow-no-rt --domain "$domain" \
        "${controller_security[@]}" "$@" >&"$log" 2>&1 &
    controller=$!
    exec {log}>&-
    started+=("$controller")
}
# end_hrtc [CODE]: waits until the program of start_hrtc ends by itself with that code, or 0.
end_hrtc() {
    local code=0
    wait "$controller" || code=$?
    cat hrtc.log
    ((code == ${1:-0})) || fail "hrtc ended with $code"
}
# stop_hrtc: ends it, with success. Used for runs that wait for the other side's events.
stop_hrtc() {
    kill -TERM "$controller" || fail "hrtc had ended before it was stopped: $(cat hrtc.log)"
    end_hrtc 0
}

# run_hrtc ARGUMENT...: runs to a successful end; the output is in hrtc.log. A machine that stalls
# the loop ends the force each time, and the hand may lose the contact; one that stalls a server
# longer than its liveliness makes it a lost one. The run is then repeated with a note, five times
# in all. With contact=0 no touch is expected.
run_hrtc() {
    local try
    for try in 1 2 3 4 5; do
        start_hrtc --report report.json --wait "$patience_s" "$@"
        end_hrtc
        was_disturbed report.json || break
        echo "held up by the machine, run $try"
    done
}

# was_held_up FILE: true if the machine stalled the loop.
was_held_up() { ! "$check_report" "$1" safety.begun.stall == 0 >/dev/null; }
was_disturbed() {
    ! "$check_report" "$1" wire.server_lost == 0 >/dev/null || {
        was_held_up "$1" \
            && ! "$check_report" "$1" force.contact_share '>=' "${contact:-0.5}" >/dev/null
    }
}

# check_contact FILE KEY SHARE: expects more than this share of the frames in contact; some if the
# loop was stalled each time.
check_contact() {
    local share=$3
    ! was_held_up "$1" || share=0
    check "$1" "$2" '>' "$share"
}

# check FILE [LEFT OP RIGHT]...: see check_report.py.
check() {
    "$check_report" "$@" || fault "$1, see above"
}

# check_sizes FILE...: expects a summary and at most 40 lines a second in these logs.
check_sizes() {
    local file
    for file; do
        (($(wc -l <"$file") < 100 + 40 * SECONDS)) || fault "$file is full"
    done
}

# check_clean FILE: checks the laws of every run, and its keys against the page; under a sanitizer,
# which allocates and faults itself, only the presence of the keys.
check_clean() {
    python3 -B "$checkout/docs/site/report_keys.py" "$checkout" "$1" || fault "$1, see above"
    check "$1" schema == 3 realtime.allocations '>=' 0 realtime.page_faults '>=' 0 \
        deadline.overrun '>=' 0
    if [[ -z "$sanitizer" ]]; then
        check "$1" realtime.allocations_counted == 1 realtime.allocations == 0
    fi
    if [[ -z "$sanitizer" ]] && is_realtime "$1"; then
        check_no_overrun "$1"
    fi
}

# check_no_overrun FILE: expects no overrun. If the kernel may move locked memory, a moved page is
# a fault (docs/deadline-test.md): a few are permitted, and those that it has moved meanwhile.
check_no_overrun() {
    if [[ $(cat /proc/sys/vm/compact_unevictable_allowed 2>/dev/null) == 1 ]]; then
        check "$1" deadline.overrun '<=' '1*deadline.cycles.page_fault' \
            deadline.cycles.page_fault '<=' $((3 + $(pages_moved) - pages_moved_before))
    else
        check "$1" deadline.overrun == 0
    fi
}
pages_moved() { awk '$1 == "pgmigrate_success" { print $2 }' /proc/vmstat; }
pages_moved_before=$(pages_moved)
readonly pages_moved_before

# deadline_test ARGUMENT...: hrtc deadline-test with its report in run.json and its output in
# test.log; its exit code, which agrees with the report, is in $ended_with. It is 0 unless the
# machine was too busy three times. No try may contain actions of the loop that a machine cannot
# cause. Without locked memory and SCHED_FIFO the loop has overruns of its own, and a sanitizer adds
# more.
deadline_test() {
    local try
    for try in 1 2 3; do
        ended_with=0
        rm -f run.json
        "$hrtc" deadline-test --allow-no-rt --transport file --report run.json "$@" >test.log 2>&1 \
            || ended_with=$?
        cat test.log
        check run.json passed == $((ended_with == 0))
        [[ -z "$sanitizer" ]] && is_realtime run.json || return 0
        check run.json self_check.injected == 20 self_check.flagged == 20 \
            deadline.cycles.allocation+deadline.cycles.over_work == 0 \
            deadline.cycles.gave_way == 0
        ((ended_with != 0)) || return 0
        echo "not passed, try $try"
    done
}

# is_realtime FILE: true if that run had SCHED_FIFO and locked memory.
is_realtime() { "$check_report" "$1" machine.fifo == 1 machine.memory_locked == 1 >/dev/null; }

# check_answers FILE: checks the figures that a run with a live server must reach. Silence of a
# server, which makes answers stale, depends on the machine.
check_answers() {
    check_contact "$1" force.contact_share 0.6
    check "$1" answers.bounded '<' '0.01*frames' \
        answers.exact+answers.separated+answers.within_tolerance+answers.bounded+answers.stale \
            == '1*frames'
}
