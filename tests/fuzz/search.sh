#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# search.sh BUILD NAME FOLDER SECONDS: runs libFuzzer with target NAME from its seeds in
# FOLDER/corpus. New inputs are stored in BUILD/learnt/NAME, where the next run begins; an input
# that breaks something is stored in BUILD/found. Skips (77) if the target was not built.
set -euo pipefail
readonly build=$1 name=$2 folder=$3 seconds=$4
readonly target=$build/tests/fuzz_$name

[[ -x "$target" ]] || {
    echo "skipped: $target was not built"
    exit 77
}
mkdir -p "$build/learnt/$name" "$build/found"
options=(-max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=256
    -artifact_prefix="$build/found/$name-" -print_final_stats=1)
case "$name" in
    chunk_link) options+=(-max_len=96) ;;
    *) options+=(-max_len=8192) ;;
esac
if [[ -f "$folder/words/$name.txt" ]]; then
    options+=(-dict="$folder/words/$name.txt")
fi
"$target" "${options[@]}" "$build/learnt/$name" "$folder/corpus/$name" >"$build/$name.log" 2>&1 || {
    tail -n 60 "$build/$name.log"
    exit 1
}
grep -E '^(stat::number_of_executed_units|stat::new_units_added|Done)' "$build/$name.log"
