# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Functions of this folder's scripts.

fail() { # fail TEXT: prints one line, then ends.
    printf '%s: %s\n' "$(basename "$0")" "$1" >&2
    exit 2
}
skip() {
    printf '%s: skipped: %s\n' "$(basename "$0")" "$1"
    exit 77
}
need_tools() { # need_tools TOOL...
    local tool
    for tool; do
        command -v "$tool" >/dev/null || skip "$tool is missing (cmake/packages-rt*.txt)"
    done
}
need_space() { # need_space FOLDER GB
    local free_kb
    free_kb=$(df --output=avail -k "$1" | tail -n 1)
    ((free_kb >= $2 * 1000000)) \
        || fail "$1 has $((free_kb / 1000)) MB free, this needs $2 GB"
}
# await COMMAND...: runs it, and ends it when this script is ended.
child=
end_child() {
    [[ -z "$child" ]] || kill -TERM "$child" 2>/dev/null || true
    [[ -z "$child" ]] || wait "$child" 2>/dev/null || true
}
trap 'exit 2' INT TERM HUP
await() {
    local code=0
    "$@" &
    child=$!
    wait "$child" || code=$?
    child=
    return "$code"
}
trap end_child EXIT
