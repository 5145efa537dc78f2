#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# One command from a fresh Debian 12 machine to a build, the tests or the demo; see --help.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
readonly root
readonly build=${TACTUS_BUILD_DIR:-$root/build/release}
readonly demo=${TACTUS_BUILD_DIR:-$root/build}/demo

usage() {
    cat <<'TEXT'
Usage: bash cmake/setup.sh COMMAND [OPTIONS] [-- CTEST-OPTIONS | -- BENCH-OPTIONS]

Commands:
  build     install missing packages and build everything in build/release
  programs  install missing packages and build the programs only, in a fraction of the time
  test      build, then run the tests that show whether Tactus works on this machine; the last line
            names the tests left out. CTEST-OPTIONS after -- replace the selection, for example
            -- -R integration or -- -L bench
  demo      build the programs, make a model, publish it over DDS on this machine and touch it for
            10 s at 1 kHz; the report is build/demo/report.json. --scene: 200 objects and two
            simulated operators; --carve: the operator carves a channel; --view: a browser shows it
  bench     build the benchmarks and run every suite; the results in build/bench are JSON and text.
            BENCH-OPTIONS after -- are for tactus_bench, for example -- --core 1
  docs      build the pages and the API reference as a site in build/docs/html; a dead link or
            another fault of a page is an error
  rt-machine  build the Debian packages and a Debian 12 with a PREEMPT_RT kernel, and run it in QEMU
            with time counted in instructions: services, deadline tests, faults; figures and logs
            are in build/rt_machine
  packages  install missing packages only

Options:
  --quick       bench: fewer frames and repeats, about three minutes instead of an hour;
                rt-machine: seconds instead of minutes of virtual time
  --peers       bench: also measure the libraries of cmake/packages-bench.txt, and install them if
                needed; some are under the GPL, none becomes part of Tactus. Without --quick, also
                count instructions with valgrind
  --docs        bench: like --peers, and store the results in docs/benchmarks and draw the pictures;
                a quick run does not replace a full one; needs TACTUS_MESHES.
                rt-machine: store the results there
  --arm64       rt-machine: programs and a kernel for arm64, built by Debian's cross compiler, in
                build/rt_machine_arm64
  --all         test: every test, long runs and builds by other compilers included (hours)
  --ci          packages: also those of .ci/run (cmake/packages-ci.txt, cmake/packages-docs.txt)
  --bench       packages: also the peers of tactus_bench (cmake/packages-bench.txt)
  --scene       demo: a scene instead of one model
  --carve       demo: carve a channel into the model, and print the removed volume
  --view        demo: serve a live view at the printed address
  --seconds N   demo: duration in seconds, 1 to 3600 [default: 10]
  --domain N    demo: DDS domain, 0 to 232 [default: that of the programs]
  --help        print this text

Environment: CXX names the compiler [default: g++]. ccache is used if it is installed.
TACTUS_BUILD_DIR names a finished build folder: the demo then uses its programs, installs and
builds nothing, and writes into its folder demo; other commands refuse it.
Exit codes: 0 done; 1 a test failed, the demo or bench missed a criterion, a page of docs is faulty,
or --docs kept older results; 2 failed at run time; 3 wrong usage.
TEXT
}

fail() { # fail CODE TEXT: one clear line, then the end.
    printf 'setup.sh: %s\n' "$2" >&2
    exit "$1"
}

# --- packages ------------------------------------------------------------------------------------

# The names in the lists given, without comments.
packages_in() { sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$@"; }

# The packages of the lists given that dpkg does not know as installed.
missing_packages() {
    local wanted known
    mapfile -t wanted < <(packages_in "$@")
    # It fails when it does not know one of the names; the lines that it prints are right even so.
    known=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null) || true
    comm -23 <(printf '%s\n' "${wanted[@]}" | LC_ALL=C sort -u) \
        <(sed -n 's/^installed //p' <<<"$known" | LC_ALL=C sort -u)
}

install_packages() { # install_packages LIST...: calls apt-get only when something is missing.
    if ! command -v dpkg-query >/dev/null; then
        echo "setup.sh: no dpkg here; going on with what is installed (names: cmake/packages.txt)"
        return
    fi
    local missing as_root=()
    mapfile -t missing < <(missing_packages "$@")
    if ((${#missing[@]} == 0)); then
        return
    fi
    if ((EUID != 0)); then
        sudo -n true 2>/dev/null || fail 2 "missing packages and no root; run: apt-get install\
 --no-install-recommends ${missing[*]}"
        as_root=(sudo -n)
    fi
    echo "Installing: ${missing[*]}"
    local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq)
    "${apt[@]}" update || fail 2 "apt-get update failed; still missing: ${missing[*]}"
    "${apt[@]}" install -y --no-install-recommends "${missing[@]}" \
        || fail 2 "apt-get install failed; still missing: ${missing[*]}"
}

# --- build ---------------------------------------------------------------------------------------

# Compile jobs: one per core, but 2 GB each, which the heaviest sources with Eigen need.
job_count() {
    local cores memory_kb by_memory
    cores=$(nproc)
    memory_kb=$(sed -n 's/^MemAvailable: *\([0-9]*\) kB/\1/p' /proc/meminfo)
    by_memory=$((${memory_kb:-0} / 2000000))
    ((by_memory >= 1)) || by_memory=1
    echo $((cores < by_memory ? cores : by_memory))
}

bench_peers= # Of tactus_bench, by their names in CMake.
with_tests=ON
build_targets() { # build_targets TARGET...
    local compiler options
    compiler=$(command -v "${CXX:-g++}") || fail 2 "CXX names '${CXX:-g++}', which is not here"
    options=("-DCMAKE_CXX_COMPILER=$compiler" "-DTACTUS_BENCH_PEERS=$bench_peers"
        "-DTACTUS_TESTS=$with_tests")
    # CMake drops the other settings when the compiler of a configured folder changes.
    if ! grep -qs "^CMAKE_CXX_COMPILER:.*=$compiler\$" "$build/CMakeCache.txt"; then
        options+=(--fresh)
    fi
    if command -v ccache >/dev/null; then
        options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    (cd "$root" && cmake --preset release "${options[@]}") || fail 2 "configuring $build failed"
    cmake --build "$build" --parallel "$(job_count)" --target "$@" || fail 2 "the build failed"
}

build_programs() { # build_programs PROGRAM...
    install_packages "$root/cmake/packages.txt"
    # The tests' packages may be missing; a folder that has them keeps them.
    grep -qs '^TACTUS_TESTS:BOOL=ON$' "$build/CMakeCache.txt" || with_tests=OFF
    build_targets "$@"
}

# --- test ----------------------------------------------------------------------------------------

# Labels of what tells nothing about this machine: checks of the sources, pages and packages, builds
# by other compilers, benchmarks, and runs of many minutes. `.ci/run` has them.
readonly left_out='^(bench|extended|guard|hostile|other_builds|packages|pictures)$'

# Names of the tests that were not run, one per line: from ctest's JUnit file, and from those that
# the test programs wrote.
skipped_tests() {
    local results program
    local skip='s/^.*<testcase name="([^"]*)".* result="skipped".* classname="([^"]*)".*$/\2.\1/p'
    sed -n 's/^.*<testcase name="\([^"]*\)".* status="notrun".*$/\1/p' "$1"
    for results in "$build"/tests/results/*.xml; do
        [[ -e "$results" ]] || continue # No test of GoogleTest was among them.
        program=$(basename "$results")
        sed -nE "$skip" "$results" | sed "s|^|${program%%.*}.|"
    done
}

# The line about the tests of those labels.
name_left_out() {
    local count
    count=$(ctest --test-dir "$build" -N --label-regex "$left_out" | sed -n 's/^Total Tests: //p')
    echo "Left out: $count tests with the labels ${left_out//[^a-z_|]/};" \
        "'bash cmake/setup.sh test --all' runs all, '... test -- -L bench' those of one label"
}

run_tests() { # run_tests [CTEST-OPTION...]: without options those that are not left out.
    local code=0 junit="$build/tests.xml" note=:
    if (($# == 0)); then
        set -- --label-exclude "$left_out"
        note=name_left_out
    fi
    rm -rf "$junit" "$build/tests/results"
    mkdir -p "$build/tests/results"
    # The limit is against what hangs.
    ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel $((2 * $(nproc))) \
        --timeout 1200 --output-junit "$junit" "$@" || code=1
    if [[ -f "$junit" ]]; then
        skipped_tests "$junit" >"$build/skipped_tests.txt"
    fi
    "$note"
    return "$code"
}

# --- demo ----------------------------------------------------------------------------------------

# Whether this user may lock memory and run a thread at a real-time priority, as hrtc will ask.
may_run_realtime() {
    local capabilities
    chrt -f 80 true 2>/dev/null || return 1
    [[ $(ulimit -l) == unlimited ]] && return 0
    capabilities=$(sed -n 's/^CapEff:[[:space:]]*//p' /proc/self/status)
    (((0x$capabilities >> 14) & 1)) # CAP_IPC_LOCK
}

programs=() # Process ids of what runs beside hrtc.
stop_programs() {
    local program
    for program in "${programs[@]}"; do
        kill -TERM "$program" 2>/dev/null || continue
        for _ in {1..50}; do
            kill -0 "$program" 2>/dev/null || continue 2
            sleep 0.1
        done
        kill -KILL "$program" 2>/dev/null || true
    done
    programs=()
}

start_program() { # start_program READY NAME OPTION...: until its log has a line with READY.
    local ready=$1 name=$2
    local log="$demo/$name.log"
    "$build/bin/$name" "${@:3}" >"$log" 2>&1 &
    programs+=("$!")
    trap stop_programs EXIT
    trap 'exit 2' INT TERM
    until grep -q "$ready" "$log"; do
        kill -0 "${programs[-1]}" 2>/dev/null || {
            cat "$log" >&2
            fail 2 "$name ended before it was ready; its last words are above"
        }
        sleep 0.1 # It reads models first.
    done
}

start_view() { # start_view OPTION...: tells where, and opens a browser where there is a screen.
    local url
    start_program '^http[^ ]* shows ' spm_view "$@" --port 0 # A free one.
    url=$(sed -n 's/^\(http[^ ]*\) shows .*/\1/p' "$demo/spm_view.log")
    echo "View: $url"
    if [[ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]] && command -v xdg-open >/dev/null; then
        xdg-open "$url" >/dev/null 2>&1 || true
    fi
}

make_model() {
    "$build/bin/spm_build" --shape bumpy-sphere --faces 200000 -o "$demo/bumpy.spm" \
        || fail 2 "spm_build could not make $demo/bumpy.spm"
}

make_scene() {
    python3 "$root/cmake/demo_scene.py" "$demo/scene.glb" \
        || fail 2 "demo_scene.py could not make $demo/scene.glb"
    "$build/bin/spm_build" "$demo/scene.glb" -o "$demo/scene" | tail -n 1
    [[ ${PIPESTATUS[0]} == 0 ]] || fail 2 "spm_build could not make $demo/scene"
}

run_demo() { # run_demo SECONDS [DOMAIN [WITH_SCENE [WITH_VIEW [WITH_CARVE]]]]
    local code=0 network=() realtime=() report="$demo/report.json" program
    local served=("$demo/bumpy.spm") touched=(--model bumpy) models=("$demo/bumpy.spm")
    for program in spm_build spm_publish hrtc ${4:+spm_view}; do
        [[ -x "$build/bin/$program" ]] || fail 2 "$build/bin/$program is not built"
    done
    if [[ -n "${2:-}" ]]; then
        network=(--domain "$2")
    fi
    mkdir -p "$demo"
    rm -f "$report"
    if [[ -n "${3:-}" ]]; then
        make_scene
        served=("$demo/scene/scene.gltf")
        touched=(--scene scene --tools 2 --pool-mib 8)
        models=("$demo"/scene/*.spm)
    else
        make_model
    fi
    if [[ -n "${5:-}" ]]; then
        # The view takes the model from its server, whose edits it then shows.
        served+=(--edits)
        touched+=(--tool sphere:0.002 --motion slide --edit carve:100 --pool-mib 8)
        models=()
    fi
    if ! may_run_realtime; then
        echo "No right to SCHED_FIFO or locked memory here: running with --allow-no-rt, so the" \
            "times below are those of an ordinary thread."
        realtime=(--allow-no-rt)
    fi
    start_program 'ready on DDS domain' spm_publish "${served[@]}" "${network[@]}"
    if [[ -n "${4:-}" ]]; then
        start_view "${models[@]}" "${network[@]}"
    fi
    "$build/bin/hrtc" "${touched[@]}" --device sim --rate 1000 --duration "$1" --report "$report" \
        "${realtime[@]}" "${network[@]}" || code=$?
    stop_programs
    if [[ -n "${5:-}" ]]; then
        sed -n 's/^.*edits of .bumpy.: /Edits: /p' "$demo/spm_publish.log"
    fi
    if [[ -f "$report" ]]; then
        echo "Report: $report"
    fi
    return "$code"
}

# --- bench ---------------------------------------------------------------------------------------

readonly python=/usr/bin/python3 # Debian's, which its matplotlib is for.
run_bench() { # run_bench KEPT OPTION...: all suites, as tactus_bench takes options.
    local results=$root/build/bench kept=$1
    shift
    mkdir -p "$results/models"
    local code=0
    rm -f "$results"/bench.*
    "$build/bin/tactus_bench" all --cache "$results/models" --json "$results/bench.json" "$@" \
        >"$results/bench.txt" || code=$?
    if [[ -f "$results/bench.json" ]]; then
        grep 'goals met' "$results/bench.txt" | sed 's/^/  /' || true
        echo "Results: $results/bench.json, and bench.txt beside it"
    fi
    if [[ -n "$kept" && -f "$results/bench.json" ]]; then
        "$python" "$root/tests/bench/results.py" store "$kept" "$results/bench.json" || code=$?
        "$python" "$root/tests/bench/plots.py" draw "$kept" || code=$?
        echo "Differences between the pages and these results:"
        "$python" "$root/tests/bench/results.py" check "$kept" "$kept.md" \
            "$root/docs/your-mesh.md" "$root/README.md" || code=$?
    fi
    return "$code"
}

# --- rt-machine ----------------------------------------------------------------------------------

run_rt_machine() { # run_rt_machine KEPT ARCHITECTURE OPTION...: empty: that of this machine.
    local code=0 kept=$1 architecture=$2 results=$root/build/rt_machine packages=$root/build/deb
    shift 2
    if command -v ccache >/dev/null; then
        export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
    fi
    (cd "$root" && cmake --workflow --preset deb) || fail 2 "the packages could not be built"
    if [[ -n "$architecture" ]]; then
        results+=_$architecture
        bash "$root/tests/rt_machine/cross_packages.sh" "$architecture" "$packages" \
            "$packages-$architecture" || return 2 # It has said why.
        packages+=-$architecture
    fi
    bash "$root/tests/rt_machine/rt_machine.sh" "$results" "$packages" "$@" || code=$?
    ((code != 77)) || code=2 # What it lacks it has said.
    if [[ -n "$kept" && $code -lt 2 ]]; then
        "$python" "$root/tests/bench/results.py" store "$kept" "$results/rt.json" || code=$?
    fi
    return "$code"
}

# --- command line --------------------------------------------------------------------------------

number_in() { # number_in OPTION VALUE LOW HIGH
    if [[ ! "$2" =~ ^[0-9]{1,6}$ ]] || ((10#$2 < $3 || 10#$2 > $4)); then
        fail 3 "$1 '$2': not a whole number from $3 to $4"
    fi
}

main() {
    local command='' seconds=10 domain='' more_options=()
    local lists=("$root"/cmake/packages{,-test}.txt)
    local bench_options=() peers='' targets=(all) kept='' scene='' view='' carve='' architecture=''
    while (($# > 0)); do
        case "$1" in
            build | programs | test | demo | bench | docs | rt-machine | packages)
                [[ -z "$command" ]] || fail 3 "two commands given: '$command' and '$1'"
                command=$1
                ;;
            --scene) scene=yes ;;
            --arm64) architecture=arm64 ;;
            --view) view=spm_view ;;
            --carve) carve=yes ;;
            --quick) bench_options+=(--quick) ;;
            --peers | --docs)
                [[ "$1" == --peers ]] || kept=$root/docs/benchmarks
                peers='bullet;cgal;embree;fcl;meshoptimizer;openmesh'
                ;;
            --all)
                more_options+=(--tests-regex .)
                targets+=(tests_left_out)
                ;;
            --ci) lists+=("$root"/cmake/packages-{ci,docs}.txt) ;;
            --bench) lists+=("$root/cmake/packages-bench.txt") ;;
            --seconds)
                number_in "$1" "${2:-}" 1 3600
                seconds=$2
                shift
                ;;
            --domain)
                number_in "$1" "${2:-}" 0 232
                domain=$2
                shift
                ;;
            --help | -h)
                usage
                exit 0
                ;;
            --)
                shift
                more_options+=("$@")
                break
                ;;
            *) fail 3 "unknown argument '$1'; --help lists what there is" ;;
        esac
        shift
    done
    if [[ -n "${TACTUS_BUILD_DIR:-}" && "$command" != @(|demo|packages) ]]; then
        fail 3 "TACTUS_BUILD_DIR is for the demo only; unset it for '$command'"
    fi
    if [[ "$command" == rt-machine ]]; then
        [[ -z "$peers" || -n "$kept" ]] || fail 3 "--peers is for 'bench' only"
    elif [[ "$command" != bench && (-n "$peers" || ${#bench_options[@]} -gt 0) ]]; then
        fail 3 "--quick, --peers and --docs are for 'bench' and 'rt-machine' only"
    fi
    if [[ "$command" != test && "${targets[*]}" != all ]]; then
        fail 3 "--all is for 'test' only"
    fi
    if [[ "$command" != rt-machine && -n "$architecture" ]]; then
        fail 3 "--arm64 is for 'rt-machine' only"
    fi
    if [[ "$command" != demo && -n "$scene$view$carve" ]]; then
        fail 3 "--scene, --view and --carve are for 'demo' only"
    fi
    if [[ -n "$scene" && -n "$carve" ]]; then
        fail 3 "--carve: the models of --scene are not edited"
    fi
    if [[ "$command" == bench && -n "$kept" && ! -d "${TACTUS_MESHES:-}" ]]; then
        fail 3 "--docs: TACTUS_MESHES must name the folder with the well-known meshes; the results\
 are about them"
    fi
    case "$command" in
        '') fail 3 "no command given; use build, programs, test, demo, bench, docs or --help" ;;
        packages) install_packages "${lists[@]}" ;;
        build)
            install_packages "${lists[@]}"
            build_targets all
            ;;
        programs)
            build_programs spm_build spm_inspect spm_publish spm_view tactus tactus-keys hrtc
            ;;
        test)
            install_packages "${lists[@]}"
            [[ ! " ${more_options[*]} " =~ " -L "|bench|extended ]] || targets+=(tests_left_out)
            build_targets "${targets[@]}"
            run_tests "${more_options[@]}"
            ;;
        docs)
            install_packages "$root/cmake/packages-docs.txt"
            "$python" -B "$root/docs/site/build.py" "$root" "$root/build/docs" || exit $?
            ;;
        rt-machine)
            lists=("$root"/cmake/packages{,-rt}.txt)
            [[ -z "$architecture" ]] || lists+=("$root/cmake/packages-rt-$architecture.txt")
            install_packages "${lists[@]}"
            run_rt_machine "$kept" "$architecture" "${bench_options[@]}"
            ;;
        bench)
            [[ -z "$peers" ]] || lists+=("$root/cmake/packages-bench.txt")
            install_packages "${lists[@]}"
            bench_peers=$peers
            build_targets tactus_bench
            if [[ -n "$peers" && " ${bench_options[*]} " != *' --quick '* ]]; then
                bench_options+=(--instructions) # Rows of skip.json and scene.json there.
            fi
            run_bench "$kept" "${bench_options[@]}" "${more_options[@]}"
            ;;
        demo)
            if [[ -z "${TACTUS_BUILD_DIR:-}" ]]; then
                build_programs spm_build spm_publish hrtc ${view:+"$view"}
            fi
            run_demo "$seconds" "$domain" "$scene" "$view" "$carve"
            ;;
    esac
}

main "$@"
