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

# expect_found CODE PATTERN ARGUMENT...: the same of an hrtc that first looks for what is on the
# domain. It gets more time until it has found that.
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

# Waits are for events. The limit is there for what never comes, and no machine is too busy for it.
readonly patience_s=150

# wait_until WHAT COMMAND...: the command succeeds; WHAT is named when it never does.
wait_until() {
    local what=$1 end=$((SECONDS + patience_s))
    shift
    until "$@"; do
        ((SECONDS < end)) || fail "no $what after $patience_s s: $(tail -n 20 ./*.log)"
        sleep 0.05
    done
}

# lines TEXT FILE: how many lines hold it.
lines() { grep -csF -- "$1" "$2" || true; }
# lines_of_host MODEL FILE: how many lines tell of the model's host; on a slow machine or a bad
# network others name pieces that don't come.
lines_of_host() { grep -sF -- "model '$1'" "$2" | grep -vcF ': chunk ' || true; }
has_lines() { (($(lines "$1" "$2") >= $3)); }

# wait_for_line FILE TEXT [COUNT]: so many lines at least, or one, hold the text.
wait_for_line() { wait_until "'$2' in $1" has_lines "$2" "$1" "${3:-1}"; }

# frames_in FILE [NAME]: the frames that a controller, or the one of that name, had run when the
# host whose words are in FILE, one with --watch, last printed them. It does so once a second.
frames_in() {
    awk -v name="${2:-}" '
        $1 == "watch" && (name == "" || $2 == name ":") && $3 > most { most = $3 + 0 }
        END { print most + 0 }' "$1"
}
has_frames() { (($(frames_in "$2" "${3:-}") >= $1)); }

# wait_for_frames COUNT FILE [NAME]: so many are printed there.
wait_for_frames() { wait_until "controller with $1 frames in $2" has_frames "$@"; }

# wait_for_more_frames COUNT FILE [NAME]: so many are run after this call.
wait_for_more_frames() {
    wait_for_frames $(($(frames_in "${@:2}") + 1)) "${@:2}"
    wait_for_frames $(($(frames_in "${@:2}") + $1)) "${@:2}"
}

# wait_for_contact FILE [NAME]: that controller is printed as one that touches something.
wait_for_contact() {
    wait_until "contact in $1" grep -Eqs "^watch ${2:-[^ ]*}: .* N in contact" "$1"
}

# wait_for_sleeps COUNT ID: a thread of that process has slept so often. One of hrtc's does so up to
# three times a millisecond.
wait_for_sleeps() { wait_until "thread of process $2 that slept $1 times" has_slept "$@"; }
has_slept() { (($(sleeps_of "$2") >= $1)); }
sleeps_of() {
    awk '$1 == "voluntary_ctxt_switches:" && $2 > most { most = $2 } END { print most + 0 }' \
        "/proc/$1/task/"*/status 2>/dev/null
}
# wait_for_more ID [SLEEPS]: that process goes on for so long, an hrtc for a second.
wait_for_more() { wait_for_sleeps $(($(sleeps_of "$1") + ${2:-3000})) "$1"; }

# start_publisher ARGUMENT...: returns when it is ready; its id is in $publisher, its words in
# publish.log.
start_publisher() {
    : >publish.log
    "${on_host[@]}" "$publish" --domain "$domain" "$@" >publish.log 2>&1 &
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
# stop_publisher: the one that was started last, which must end well.
stop_publisher() {
    stop TERM "$publisher"
    ((stopped_with == 0)) || fault "spm_publish ended with $stopped_with: $(cat publish.log)"
}

# start_hrtc ARGUMENT...: in the background; its id is in $controller, its words in hrtc.log.
start_hrtc() {
    "${on_controller[@]}" "$hrtc" --allow-no-rt --domain "$domain" "$@" >hrtc.log 2>&1 &
    controller=$!
    started+=("$controller")
}
# end_hrtc [CODE]: what start_hrtc started ends by itself with that code, or with 0.
end_hrtc() {
    local code=0
    wait "$controller" || code=$?
    cat hrtc.log
    ((code == ${1:-0})) || fail "hrtc ended with $code"
}
# stop_hrtc: it is told to end, and ends well. A run in which the other side's events are waited for
# is ended when they have come.
stop_hrtc() {
    kill -TERM "$controller" || fail "hrtc had ended before it was stopped: $(cat hrtc.log)"
    end_hrtc 0
}

# run_hrtc ARGUMENT...: to its end, which must be a good one; its words in hrtc.log. A machine that
# holds the loop up ends the force each time, and the hand may lose what it touches; one that holds
# a host up for longer than its liveliness makes it one that is lost. Then it says so and runs
# again, five times in all. With contact=0 no touch is expected.
run_hrtc() {
    local try
    for try in 1 2 3 4 5; do
        start_hrtc --report report.json --wait "$patience_s" "$@"
        end_hrtc
        was_disturbed report.json || break
        echo "held up by the machine, run $try"
    done
}

# was_held_up FILE: whether the machine stalled the loop.
was_held_up() { ! "$check_report" "$1" safety.begun.stall == 0 >/dev/null; }
was_disturbed() {
    ! "$check_report" "$1" wire.host_lost == 0 >/dev/null || {
        was_held_up "$1" \
            && ! "$check_report" "$1" force.contact_share '>=' "${contact:-0.5}" >/dev/null
    }
}

# check_contact FILE KEY SHARE: more than this share of the frames in contact; some are where the
# loop was held up each time.
check_contact() {
    local share=$3
    ! was_held_up "$1" || share=0
    check "$1" "$2" '>' "$share"
}

# check FILE [LEFT OP RIGHT]...: see check_report.cpp.
check() {
    "$check_report" "$@" || fault "$1, see above"
}

# check_sizes FILE...: these logs hold a summary and no more than 40 lines a second.
check_sizes() {
    local file
    for file; do
        (($(wc -l <"$file") < 100 + 40 * SECONDS)) || fault "$file is full"
    done
}

# check_clean FILE: what holds for every run. Under a sanitizer, which allocates and faults on its
# own account, only that the keys are there.
check_clean() {
    check "$1" schema == 3 realtime.allocations '>=' 0 realtime.page_faults '>=' 0 \
        deadline.own_fault '>=' 0
    if [[ -z "$sanitizer" ]]; then
        check "$1" realtime.allocations_counted == 1 realtime.allocations == 0
    fi
    if [[ -z "$sanitizer" ]] && is_realtime "$1"; then
        check_no_own_fault "$1"
    fi
}

# check_no_own_fault FILE: but where the kernel may move locked memory, a page that it moves is a
# fault (docs/deadline-test.md): no more than a few, and those that it has moved meanwhile.
check_no_own_fault() {
    if [[ $(cat /proc/sys/vm/compact_unevictable_allowed 2>/dev/null) == 1 ]]; then
        check "$1" deadline.own_fault '<=' '1*deadline.cycles.page_fault' \
            deadline.cycles.page_fault '<=' $((3 + $(pages_moved) - pages_moved_before))
    else
        check "$1" deadline.own_fault == 0
    fi
}
pages_moved() { awk '$1 == "pgmigrate_success" { print $2 }' /proc/vmstat; }
pages_moved_before=$(pages_moved)
readonly pages_moved_before

# deadline_test ARGUMENT...: hrtc deadline-test with its report in run.json and its words in
# test.log; its exit code, which the report agrees with, is in $ended_with. It is 0 unless the
# machine was too busy for that three times. The loop does nothing in any try that no machine makes
# it do. Without locked memory and SCHED_FIFO the loop has faults of its own, and a sanitizer makes
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

# is_realtime FILE: whether that run had SCHED_FIFO and locked memory.
is_realtime() { "$check_report" "$1" machine.fifo == 1 machine.memory_locked == 1 >/dev/null; }

# check_answers FILE: the figures that a run with a live host has to reach. How long a host is
# silent, which makes answers stale, is the machine's matter.
check_answers() {
    check_contact "$1" force.contact_share 0.6
    check "$1" answers.bracket '<' '0.01*frames' \
        answers.exact+answers.decided+answers.within_tolerance+answers.bracket+answers.stale \
            == '1*frames'
}
