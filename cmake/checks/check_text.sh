#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_text.sh CHECK ROOT: one guard over the text of the checkout ROOT; CHECK is a function below.
# Prints each fault as file:line: text, exit 1 when there is one, 3 on wrong usage.
set -euo pipefail
export LC_ALL=C.UTF-8 # Columns are characters, not bytes.

# Tracked and new files that git does not ignore; without git every file outside of build folders.
project_files() { # project_files GLOB...
    local file glob
    if [[ -e .git ]] && git rev-parse --git-dir >/dev/null 2>&1; then
        git ls-files --cached --others --exclude-standard
    else
        find . -type f -not -path './build*' -not -path './.git/*' | sed 's|^\./||'
    fi | LC_ALL=C sort -u | while IFS= read -r file; do
        for glob in "$@"; do
            # shellcheck disable=SC2053 # The right side is a pattern on purpose.
            if [[ "$file" == $glob && -f "$file" ]]; then
                printf '%s\n' "$file"
                break
            fi
        done
    done
}

readonly cpp=('*.hpp' '*.cpp' '*.h' '*.c' '*.idl')
readonly scripts=('*.cmake' '*CMakeLists.txt' '*.sh' '.ci/run')

# Prints the lines that match in files of the globs; false when there is one.
refuse_lines() { # refuse_lines REGEX GLOB...
    local regex=$1
    shift
    ! project_files "$@" | tr '\n' '\0' | xargs -0 -r grep -InE -e "$regex" --
}

line_length() { refuse_lines '^.{101,}' "${cpp[@]}" "${scripts[@]}"; }

# The words are spelt in two parts so that this file passes its own check.
no_leftovers() {
    refuse_lines '\b(TO''DO|FIX''ME|X''XX|HA''CK)\b' "${cpp[@]}" "${scripts[@]}" '*.md'
}

# Absolute paths of somebody's machine, but not the same words inside a longer path or an address.
machine_paths() { refuse_lines '(^|[^A-Za-z0-9_./])/(home|root|work|Users)/' '*'; }

# Two lines of licence at the top of C++; one, after the interpreter, in scripts.
licence() {
    local faults=0 file first
    while IFS= read -r file; do
        mapfile -t -n 2 first <"$file"
        if [[ "${first[0]-}" != '// SPDX-License-Identifier: Apache-2.0' ||
            "${first[1]-}" != '// Copyright the Tactus authors.' ]]; then
            echo "$file:1: does not begin with the two lines of licence"
            faults=1
        fi
    done < <(project_files "${cpp[@]}")
    while IFS= read -r file; do
        if ! head -n 2 "$file" | grep -qxF '# SPDX-License-Identifier: Apache-2.0'; then
            echo "$file:1: has no SPDX line at the top"
            faults=1
        fi
    done < <(project_files "${scripts[@]}")
    return "$faults"
}

# Whether a CMakeLists.txt in one of the folders above names the path relative to that folder.
is_listed() { # is_listed PATH
    local folder=$1 name pattern
    while folder=$(dirname "$folder") && [[ "$folder" != / ]]; do
        if [[ "$folder" == . ]]; then
            name=$1
        else
            name=${1#"$folder"/}
        fi
        pattern="(^|[[:space:](\"/])${name//./\\.}([[:space:])\"]|\$)"
        # No pipe: grep leaves at the first match, and sed would fail on what it still has to write.
        if [[ -f "$folder/CMakeLists.txt" ]] \
            && grep -qE "$pattern" < <(sed 's/#.*//' "$folder/CMakeLists.txt"); then
            return 0
        fi
        [[ "$folder" != . ]] || return 1
    done
}

# A source, header or test folder that no CMakeLists.txt names is never built or never run.
files_listed() {
    local faults=0 file
    while IFS= read -r file; do
        if ! is_listed "$file"; then
            echo "$file:1: no CMakeLists.txt above it lists it"
            faults=1
        fi
    done < <(
        project_files {rt_core,transport,platform,host_tools}/'*.'{hpp,cpp,idl} 'tests/*.cpp'
        project_files '*/CMakeLists.txt' | xargs -r -n 1 dirname
    )
    return "$faults"
}

# A constant of rt_core/limits.hpp that no test names, comments aside, is a limit that nobody has
# ever reached. Programs that measure are no tests.
limits_tested() {
    local limits=rt_core/limits.hpp named line name faults=0
    named=$(project_files 'tests/*/test_*.cpp' | grep -v '^tests/bench/' | tr '\n' '\0' \
        | xargs -0 -r sed 's|//.*||' | grep -owE 'k[A-Z][A-Za-z0-9_]*' | sort -u)
    while IFS=: read -r line name; do
        if ! grep -qxF "$name" <<<"$named"; then
            echo "$limits:$line: $name is named in no tests/*/test_*.cpp"
            faults=1
        fi
    done < <(grep -nE '^(inline )?constexpr ' "$limits" \
        | sed -E 's/^([0-9]+):.* (k[A-Z][A-Za-z0-9_]*) = .*/\1:\2/')
    return "$faults"
}

# A header that its own source includes first is compiled by itself there; all others are by
# .ci/run (cmake/rt_flags.cmake).
own_header_first() {
    local faults=0 file header line
    while IFS= read -r file; do
        header=${file%.cpp}.hpp
        [[ -f "$header" ]] || continue
        line=$(grep -nm 1 '^#include' "$file")
        if [[ "${line#*:}" != "#include \"$header\"" ]]; then
            echo "$file:${line%%:*}: its own header, $header, is not the first include"
            faults=1
        fi
    done < <(project_files {rt_core,transport,platform,host_tools}/'*.cpp')
    return "$faults"
}

# A header that is installed says in a comment which thread may use it.
threads_told() {
    local faults=0 header headers
    headers=$(sed 's/#.*//' cmake/components.cmake \
        | grep -oE '\b(rt_core|transport|platform|host_tools)/[a-z0-9_/]+\.(hpp|h)\b' | sort -u)
    while IFS= read -r header; do
        if ! grep -qiE '(//|/\*|^ \*).*thread' "$header"; then
            echo "$header:1: is installed, and no comment says which thread may use it"
            faults=1
        fi
    done <<<"$headers"
    return "$faults"
}

readonly checks=(line_length no_leftovers machine_paths licence files_listed limits_tested
    own_header_first threads_told)
if (($# != 2)) || [[ " ${checks[*]} " != *" $1 "* ]]; then
    echo "usage: check_text.sh CHECK ROOT, CHECK being one of: ${checks[*]}" >&2
    exit 3
fi
cd "$2"
if [[ -z $(project_files '*CMakeLists.txt') ]]; then
    echo "check_text.sh: no CMakeLists.txt below '$2'; is this the checkout?" >&2
    exit 3
fi
"$1"
