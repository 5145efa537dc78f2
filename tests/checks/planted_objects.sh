#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# planted_objects.sh CHECKOUT SCRATCH CXX [PYTHON]: the guards over objects must pass on clean ones
# and must name faults planted in others. Without PYTHON only the guards over symbols are run, which
# work with every compiler; the others read x86-64 machine code of g++.
set -euo pipefail
readonly checks="$1/cmake/checks" scratch=$2 cxx=$3 python=${4:-}
failures=0 flags=(-std=c++20 -O1)
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

# archive NAME FLAGS...: compiles standard input to NAME.o and to the only object in lib.a.
archive() {
    local name=$1
    shift
    cat >"$name.cpp"
    rm -f lib.a ./*.o ./*.su
    "$cxx" "${flags[@]}" "$@" -c "$name.cpp" -o "$name.cpp.o"
    ar rcs lib.a "$name.cpp.o"
}

expect() { # expect CODE TEXT COMMAND...: expects that exit code, and TEXT in the output.
    local code=0 output wanted=$1 text=$2
    shift 2
    output=$("$@" 2>&1) || code=$?
    if ((code != wanted)) || [[ "$output" != *"$text"* ]]; then
        printf '%s: expected exit %d and "%s"; exit %d and:\n%s\n' "$(basename "$2")" "$wanted" \
            "$text" "$code" "$output"
        failures=$((failures + 1))
    fi
}

report() {
    if ((failures > 0)); then
        echo "$failures faults are not seen as they should"
        exit 1
    fi
    cd /
    rm -rf "$scratch"
}

# --- Symbols: the heap, and calls of one system in objects with and without permission.
archive heap <<<'int* make() { return new int(1); }'
expect 1 'operator new(unsigned long) in heap.cpp.o' bash "$checks/check_rt_core_symbols.sh" lib.a \
    "$checks/rt_core_symbols.txt"

platform() { # platform CODE TEXT OBJECT CALL: checks an archive whose object makes the call.
    archive "$3" -w <<<"extern \"C\" int $4(...); int run() { return $4(1); }"
    expect "$1" "$2" bash "$checks/check_platform_symbols.sh" lib.a "$checks/platform_symbols.txt"
}
platform 0 'needs nothing but' timer clock_nanosleep
platform 1 'epoll_wait in timer.cpp.o' timer epoll_wait
platform 1 'sched_getaffinity in timer.cpp.o' timer sched_getaffinity
platform 0 'needs nothing but' linux_extras sched_getaffinity
platform 1 'prctl in linux_extras.cpp.o' linux_extras prctl
platform 0 'needs nothing but' system_call_trap prctl
platform 1 'clock_gettime64 in timer.cpp.o' timer clock_gettime64

if [[ -z "$python" ]]; then
    report
    exit
fi
flags+=(-fno-inline -fno-ipa-icf)

# --- Stack.
stack() { # stack CODE TEXT [RULE]
    printf '%s\n' "${3:-}" >rules.txt
    expect "$1" "$2" "$python" "$checks/check_stack_usage.py" lib.a . rules.txt 65536 'run(*'
}

archive chain -fstack-usage <<'EOC'
void fill(volatile char* bytes) { bytes[7] = 1; }
void third() { volatile char bytes[30000]; fill(bytes); }
void second() { volatile char bytes[20000]; third(); fill(bytes); }
void run(int) { volatile char bytes[10000]; second(); fill(bytes); }
void run() { volatile char bytes[10]; fill(bytes); }
EOC
stack 0 'run(*: 60'
stack 1 'nothing needs the rule: end fourth()' 'end fourth()'
expect 3 'no function matches jump(*' "$python" "$checks/check_stack_usage.py" lib.a . rules.txt \
    65536 'jump(*'
expect 3 'usage: none' bash -c "\"$python\" \"$checks/check_stack_usage.py\" || { code=\$?
    echo usage: none; exit \$code; }"
rm -f ./*.su
expect 3 'no .su file' "$python" "$checks/check_stack_usage.py" lib.a . rules.txt 65536 'run(*'

archive deep -fstack-usage <<'EOC'
void fill(volatile char* bytes) { bytes[7] = 1; }
static void third() { volatile char bytes[30000]; fill(bytes); }
static void second() { volatile char bytes[30000]; third(); fill(bytes); }
void run() { volatile char bytes[10000]; second(); fill(bytes); }
EOC
stack 1 'third()'
stack 1 'more than 65536'

archive circle -fstack-usage <<'EOC'
int odd(int n);
int even(int n) { return n == 0 ? 1 : odd(n - 1) + 1; }
int odd(int n) { return n == 0 ? 0 : even(n - 1) + 1; }
int run(int n) { return even(n) + 1; }
EOC
stack 1 'recursion: even(int) -> odd(int) -> even(int)'
archive itself -fstack-usage <<'EOC'
int run(int n) { return n == 0 ? 1 : run(n - 1) * n + run(n / 2); }
EOC
stack 1 'recursion: run(int) -> run(int)'

archive growing -fstack-usage <<'EOC'
void fill(char* bytes) { *reinterpret_cast<volatile char*>(bytes) = 1; }
void run(unsigned long n) { fill(static_cast<char*>(__builtin_alloca(n))); }
EOC
stack 1 'run(unsigned long): its stack has no bound'

archive pointer -fstack-usage <<'EOC'
struct Table { int (*first)(int); };
int large(int n) { volatile char bytes[70000]; bytes[n] = 1; return bytes[n / 2]; }
int run(const Table* table, int n) { return table->first(n) + 1; }
EOC
stack 1 'calls through a pointer, and no rule tells whom'
stack 0 '100  what is called through a pointer' 'indirect run(* -> 100'
stack 1 'more than 65536' 'indirect run(* -> large(*'
stack 1 'no function matches small(*' 'indirect run(* -> small(*'
stack 3 'not a rule' 'indirect run(*'

archive outside -fstack-usage <<'EOC'
extern "C" int elsewhere(int n);
int run(int n) { return elsewhere(n) + 1; }
EOC
stack 1 'elsewhere: outside of the archive'
stack 0 '4000  elsewhere' 'outside elsewhere 4000'

archive choice -fstack-usage <<'EOC'
int a(int); int b(int); int c(int); int d(int); int e(int);
int run(int n)
{
    switch (n) { case 0: return a(n); case 1: return b(n) + 1; case 2: return c(n) * 3;
    case 3: return d(n) - 4; case 4: return e(n) ^ 5; case 5: return a(n) + 7; default: return 0; }
}
int a(int n) { return n; } int b(int n) { return n + 1; } int c(int n) { return n + 2; }
int d(int n) { return n + 3; } int e(int n) { volatile char x[500]; x[n] = 1; return x[n / 2]; }
EOC
stack 0 'e(int)' # A switch's jump is no call through a pointer.

# --- AVX.
avx() { expect "$1" "$2" bash "$checks/check_no_avx.sh" '*kernel*avx2*' lib.a; }

sum='float sum(const float* v) { float s = 0; for (int i = 0; i < 8; ++i) s += v[i]; return s; }'
archive plain <<<"$sum"
avx 0 'need nothing but x86-64'
archive wide -mavx <<<"$sum"
avx 1 'wide.cpp.o: sum(float const*): v'
archive bits -mbmi2 <<<'unsigned long shift(unsigned long a, int n) { return a << (n & 63); }'
avx 1 'bits.cpp.o: shift(unsigned long, int): shlx'
archive my_kernels_avx2 -mavx2 <<<"$sum"
avx 0 'left out: 1 kernel functions'
archive my_kernels_avx2 -mavx2 <<<"inline $sum float two(const float* v) { return sum(v) + v[9]; }"
avx 1 'my_kernels_avx2.cpp.o: shares sum(float const*)'
archive my_kernels_avx2 -mfma <<<'float f(float a, float b, float c) {
    return __builtin_fmaf(a, b, c); }'
avx 1 'f(float, float, float): vfm'
expect 3 'usage' bash "$checks/check_no_avx.sh" lib.a

# A program may contain AVX code of the kernels only.
archive my_kernels_avx2 -mavx2 <<<"$sum"
printf 'float sum(const float*); float one[8] = {}; int main() { return int(sum(one)); }\n' >m.cpp
"$cxx" -O1 m.cpp lib.a -o program
expect 0 '2 files need nothing' bash "$checks/check_no_avx.sh" '*kernel*avx2*' lib.a program
"$cxx" -O1 -mavx m.cpp lib.a -o program
expect 1 'program: main: v' bash "$checks/check_no_avx.sh" '*kernel*avx2*' lib.a program

# --- System calls, clocks.
instructions() { expect "$1" "$2" bash "$checks/check_rt_core_instructions.sh" lib.a; }

archive quiet <<<"$sum"
instructions 0 'no system call'
archive clock <<<'unsigned long long tick() { return __builtin_ia32_rdtsc(); }'
instructions 1 'clock.cpp.o: tick(): rdtsc'
archive call <<<'long call(long n) {
    asm volatile("syscall" : "+a"(n) : : "rcx", "r11"); return n; }'
instructions 1 'call.cpp.o: call(long): syscall'
expect 3 'usage' bash "$checks/check_rt_core_instructions.sh" nowhere.a

report
