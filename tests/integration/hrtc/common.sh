# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2034 # The scripts use what is set here.
# What the scripts of this folder share; sourced with "$@" being BIN CHECK_REPORT SANITIZER: the
# folder of the programs, the report checker, and what -fsanitize= the build had, or none. It enters
# a fresh folder that vanishes at the end together with every process that was started here.
set -euo pipefail
readonly build=$1/spm_build inspect=$1/spm_inspect publish=$1/spm_publish hrtc=$1/hrtc
readonly check_report=$2 sanitizer=${3#none}
# Our own domain, our own loopback: nobody else's models, and none of ours on a real interface.
readonly domain=${TACTUS_TEST_DOMAIN:-$(($$ % 231))}
unset CYCLONEDDS_URI
# What the programs of either side are started by: two_networks.sh fills them.
on_host=()
on_controller=()

scratch=$(mktemp -d)
started=() # Ids of the background processes.
leave() {
    local id
    for id in "${started[@]}"; do
        kill -KILL "$id" 2>/dev/null || true
        wait "$id" 2>/dev/null || true # Without it bash tells of the kill.
    done
    rm -rf "$scratch"
}
trap leave EXIT
cd "$scratch"

# model SHAPE-FACES FILE: of make_models.sh where it has run, otherwise made here.
model() {
    local made=${TACTUS_TEST_MODELS:-}/$1.spm
    if [[ -f "$made" ]]; then
        cp "$made" "$2"
    else
        "$build" --shape "${1%-*}" --faces "${1##*-}" -o "$2" >build.log 2>&1
    fi
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

# expect CODE PATTERN PROGRAM ARGUMENT...: that exit code, and exactly one line, which begins with
# the program's name, perhaps with a subcommand's, and holds what matches PATTERN.
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

# wait_until SECONDS WHAT COMMAND...: it succeeds; WHAT says what never came.
wait_until() {
    local i most_s=$1 what=$2
    shift 2
    for ((i = 0; i < most_s * 20; ++i)); do
        "$@" && return
        sleep 0.05
    done
    fail "no $what after $most_s s"
}

# wait_for_line FILE TEXT SECONDS
wait_for_line() {
    local i
    for ((i = 0; i < $3 * 20; ++i)); do
        grep -qsF -- "$2" "$1" && return
        sleep 0.05
    done
    cat "$1" || true
    fail "no '$2' in $1 after $3 s"
}

# wait_for_frames COUNT FILE [NAME]: the host whose words are in FILE, one with --watch, has heard
# that a controller, or the one of that name, has run so many. It tells so once a second.
wait_for_frames() { wait_until 20 "controller with $1 frames in $2" told_frames "$@"; }
told_frames() {
    awk -v least="$1" -v name="${3:-}" '
        $1 == "watch" && (name == "" || $2 == name ":") && $3 + 0 >= least { found = 1 }
        END { exit !found }' "$2"
}

# wait_for_sleeps COUNT ID: a thread of that process has slept so often; hrtc's loop does in each
# cycle.
wait_for_sleeps() { wait_until 20 "thread of process $2 that slept $1 times" has_slept "$@"; }
has_slept() {
    awk -v least="$1" '$1 == "voluntary_ctxt_switches:" && $2 >= least { found = 1 }
        END { exit !found }' "/proc/$2/task/"*/status 2>/dev/null
}

# start_publisher ARGUMENT...: returns when it is ready; its id is in $publisher, its words in
# publish.log.
start_publisher() {
    : >publish.log
    "${on_host[@]}" "$publish" --domain "$domain" "$@" >publish.log 2>&1 &
    publisher=$!
    started+=("$publisher")
    wait_for_line publish.log 'ready on DDS domain' 10
}

# stop SIGNAL ID: waits until the process is gone; its exit code is in $stopped_with.
stop() {
    stopped_with=0
    kill -"$1" "$2" || fail "process $2 had ended before it was stopped"
    wait "$2" 2>/dev/null || stopped_with=$?
}

# start_hrtc ARGUMENT...: in the background; its id is in $controller, its words in hrtc.log.
start_hrtc() {
    "${on_controller[@]}" "$hrtc" --allow-no-rt --domain "$domain" "$@" >hrtc.log 2>&1 &
    controller=$!
    started+=("$controller")
}

# run_hrtc ARGUMENT...: to its end, which must be a good one; its words in hrtc.log. A machine that
# holds the loop up ends the force each time, and the hand may lose what it touches: then it says so
# and runs again, three times in all.
run_hrtc() {
    local code try
    for try in 1 2 3; do
        code=0
        "${on_controller[@]}" "$hrtc" --allow-no-rt --domain "$domain" --report report.json "$@" \
            >hrtc.log 2>&1 || code=$?
        cat hrtc.log
        ((code == 0)) || fail "hrtc $* ended with $code"
        if ! was_held_up report.json || touched_most_of_the_time report.json; then
            return 0
        fi
        echo "held up by the machine, run $try"
    done
}

# was_held_up FILE: whether the machine stalled the loop.
was_held_up() { ! "$check_report" "$1" safety.begun.stall == 0 >/dev/null; }

touched_most_of_the_time() { "$check_report" "$1" force.contact_share '>' 0.5 >/dev/null; }

# check_contact FILE KEY SHARE: more than this share of the frames in contact; some of them do where
# the loop was held up each time.
check_contact() {
    local share=$3
    ! was_held_up "$1" || share=0.1
    check "$1" "$2" '>' "$share"
}

# check FILE [LEFT OP RIGHT]...: see check_report.cpp.
check() {
    "$check_report" "$@" || fault "$1, see above"
}

# check_clean FILE: what holds for every run. Under a sanitizer, which allocates and faults on its
# own account, only that the keys are there.
check_clean() {
    check "$1" schema == 2 realtime.allocations '>=' 0 realtime.page_faults '>=' 0 \
        deadline.own_fault '>=' 0
    if [[ -z "$sanitizer" ]]; then
        check "$1" realtime.allocations_counted == 1 realtime.allocations == 0
    fi
    if [[ -z "$sanitizer" ]] && is_realtime "$1"; then
        check_no_own_fault "$1"
    fi
}

# check_no_own_fault FILE: but where the kernel may move locked memory, a page that it moves is a
# fault (docs/deadline-test.md).
check_no_own_fault() {
    if [[ $(cat /proc/sys/vm/compact_unevictable_allowed 2>/dev/null) == 1 ]]; then
        check "$1" deadline.own_fault '<=' '1*deadline.cycles.page_fault' \
            deadline.cycles.page_fault '<=' 3
    else
        check "$1" deadline.own_fault == 0
    fi
}

# is_realtime FILE: whether that run had SCHED_FIFO and locked memory.
is_realtime() { "$check_report" "$1" machine.fifo == 1 machine.memory_locked == 1 >/dev/null; }

# check_answers FILE: the figures that a run with a live host has to reach.
check_answers() {
    check_contact "$1" force.contact_share 0.6
    check "$1" answers.exact+answers.decided '>' '0.99*frames' \
        answers.exact+answers.decided+answers.bracket+answers.stale == '1*frames'
}
