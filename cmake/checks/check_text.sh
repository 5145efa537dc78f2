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

has_heading() { # has_heading PAGE ANCHOR, as GitHub makes them
    sed -n 's/^##* //p' "$1" | tr '[:upper:]' '[:lower:]' | sed 's/[^a-z0-9 _-]//g; s/ /-/g' \
        | grep -qxF -e "$2"
}

# A link of a page leads to a file that is there, and to a heading of it; a page of docs/ that a
# source, a script or another page names is there.
links() {
    local faults=0 file line target path
    # shellcheck disable=SC2016 # The program of awk.
    while IFS=$'\t' read -r file line target; do
        path=${target%%#*}
        path=${path:+$(dirname "$file")/$path}
        path=${path:-$file}
        if [[ ! -e "$path" ]] \
            || { [[ "$target" == *#* ]] && ! has_heading "$path" "${target#*#}"; }; then
            echo "$file:$line: a link to '$target', which is not there"
            faults=1
        fi
    done < <(project_files '*.md' | tr '\n' '\0' | xargs -0 -r awk '
        /^ *```/ { in_code = !in_code }
        FNR == 1 { in_code = 0 }
        !in_code {
            rest = $0
            while (match(rest, /\]\([^() ]+\)/)) {
                target = substr(rest, RSTART + 2, RLENGTH - 3)
                if (target !~ /:/) print FILENAME "\t" FNR "\t" target
                rest = substr(rest, RSTART + RLENGTH)
            }
        }')
    while IFS=: read -r file line target; do
        if [[ ! -e "$target" ]]; then
            echo "$file:$line: names '$target', which is not there"
            faults=1
        fi
    done < <(project_files "${cpp[@]}" "${scripts[@]}" '*.md' '*.py' '*.txt' | tr '\n' '\0' \
        | xargs -0 -r grep -onE '\bdocs/[a-z0-9_/-]+\.(md|py|cpp|xml)\b' -- /dev/null)
    return "$faults"
}

# A test that a page names is there: `KIND.NAME`, which a CMakeLists.txt of tests/ gives to add_test
# in one word, or as KIND.${...} with the NAME, or what is behind its part_${...}, among its words;
# `test_PROGRAM`, or a source of that name, and the suites behind it.
# shellcheck disable=SC2016 # CMake's marks, and the pages'.
named_tests() {
    local faults=0 file line words kind name whole='' composed='' suites sources
    sources=$(project_files 'tests/*.cpp' 'tests/*.hpp')
    suites=$(tr '\n' '\0' <<<"$sources" | xargs -0 -r sed -nE \
        -e 's/^ *(TYPED_|RC_GTEST_)?(TEST|PROP|FIXTURE_PROP)[A-Z_]*\(([A-Za-z0-9]+).*/\3/p')
    sources=$(sed -n 's|.*/\(test_[a-z0-9_]*\)\.cpp$|\1|p' <<<"$sources")
    # Names in one word, and KIND/WORD for every word of a list that makes names of that KIND.
    while IFS= read -r file; do
        words=$(sed 's/#.*//' "$file")
        whole+=$(sed -nE -e 's/.*NAME ([a-z_]+\.[a-z0-9_]+).*/\1/p' \
            -e 's/.*tactus_(test|program)\(([a-z0-9_]+).*/\2/p' <<<"$words")$'\n'
        while IFS= read -r kind; do
            for name in '' $(grep -oE '[a-z0-9_]+_\$\{' <<<"$words" | tr -d '${'); do
                composed+=$(grep -oE '[a-z0-9_]+' <<<"$words" | sort -u \
                    | sed "s|^|$kind/$name|")$'\n'
            done
        done < <(sed -nE -e 's/.*NAME ([a-z_]+)\.\$.*/\1/p' -e 's/.*(guard)\(.*/\1/p' \
            <<<"$words" | sort -u)
    done < <(project_files 'tests/*CMakeLists.txt')
    while IFS=: read -r file line words; do
        words=${words//'`'/}
        name=${words%% *}
        kind=${name%%.*}
        if [[ "$name" == test_* && "$name" != *.* ]]; then
            grep -qxF -- "$name" <<<"$whole$sources" \
                || { echo "$file:$line: no test is called '$name'"; faults=1; }
        elif grep -qE "^${kind}[./]" <<<"$whole$composed"; then # Else something with a dot in it.
            grep -qxF -e "$name" -e "${name/./\/}" <<<"$whole$composed" \
                || { echo "$file:$line: no test is called '$name'"; faults=1; }
        fi
        [[ "$words" == *' '* ]] || continue
        for name in ${words#* }; do
            grep -qxF -- "${name%,}" <<<"$suites" \
                || { echo "$file:$line: no suite of tests is called '${name%,}'"; faults=1; }
        done
    done < <(project_files '*.md' | tr '\n' '\0' | xargs -0 -r grep -onE \
        '`(test_[a-z0-9_]+`( [A-Z][A-Za-z0-9]+,?)*|[a-z_]+\.[a-z0-9_]+`)' -- /dev/null)
    return "$faults"
}

readonly checks=(line_length no_leftovers machine_paths licence files_listed limits_tested
    own_header_first threads_told links named_tests)
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
