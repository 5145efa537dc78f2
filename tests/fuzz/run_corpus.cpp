// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// run_corpus MOST PATH...: the fixed part of fuzzing, for builds without libFuzzer. Runs each file
/// of the folders (or a single file) unchanged, cut at every byte, with every single bit flipped,
/// and with a byte more; at most MOST of these for each file, evenly chosen, without randomness.
/// Prints the input that ends the program. Exit 1 if an unchanged file is refused, unless its name
/// begins with refused_: rewrite the seeds (README.md).
#include "rt_core/base/assert.hpp"
#include "tests/fuzz/law.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

// Function of the sanitizers' run-time library, if the program has one.
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace tactus::fuzz
{

namespace
{

using Input = std::vector<std::uint8_t>;

/// Present input, to print if the program ends.
struct Current
{
    std::array<char, 256> file{};
    std::size_t variant{0};
    std::size_t bytes{0};
};

Current current;

/// Changes in order: cuts, then flips, then longer inputs.
enum class Change
{
    none,
    cut,
    flip,
    append,
};

struct Variant
{
    Change change{Change::none};
    std::size_t place{0}; ///< Bytes left, the bit's number, or the byte to append.
};

Variant variant_of(std::size_t number, std::size_t bytes)
{
    if (number == 0)
    {
        return {};
    }
    --number;
    if (number < bytes)
    {
        return {Change::cut, number};
    }
    number -= bytes;
    return number < 8 * bytes ? Variant{Change::flip, number}
                              : Variant{Change::append, number - 8 * bytes};
}

/// Number of variants: the file, its cuts, its flips and one more byte, 0 or 255.
std::size_t variants_of(std::size_t bytes)
{
    return 1 + bytes + 8 * bytes + 2;
}

Input changed(const Input& input, const Variant& variant)
{
    Input result = input;
    switch (variant.change)
    {
    case Change::none:
        break;
    case Change::cut:
        result.resize(variant.place);
        break;
    case Change::flip:
        result[variant.place / 8] ^= static_cast<std::uint8_t>(1U << (variant.place % 8));
        break;
    case Change::append:
        result.push_back(variant.place == 0 ? 0 : 255);
        break;
    }
    result.shrink_to_fit(); // Reads beyond the end are detected.
    return result;
}

void say_current() noexcept
{
    static constexpr std::array<const char*, 4> words{"as it is", "cut to bytes", "with its bit",
                                                      "with a byte more:"};
    const Variant variant = variant_of(current.variant, current.bytes);
    std::fprintf(stderr, "while running %s %s %zu\n", current.file.data(),
                 words[static_cast<std::size_t>(variant.change)], variant.place);
}

extern "C" void say_and_end(int signal)
{
    say_current();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

void print_assertion(const char* condition, const char* file, int line) noexcept
{
    std::fprintf(stderr, "%s:%d: broken assertion: %s\n", file, line, condition);
}

void listen_for_ends()
{
    set_assert_handler(print_assertion);
    if (__sanitizer_set_death_callback != nullptr)
    {
        __sanitizer_set_death_callback(say_current);
        return;
    }
    for (const int signal : {SIGABRT, SIGILL, SIGTRAP, SIGSEGV, SIGBUS, SIGFPE})
    {
        std::signal(signal, say_and_end);
    }
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& path)
{
    if (!std::filesystem::is_directory(path))
    {
        return {path};
    }
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(path))
    {
        files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

struct Tally
{
    std::size_t files{0};
    std::size_t inputs{0};
    /// Unchanged files that are refused although their names do not say so.
    std::size_t useless_files{0};
};

void run_file(const std::filesystem::path& path, std::size_t most, Tally& tally)
{
    std::ifstream file(path, std::ios::binary);
    require(file.is_open(), "the corpus can be read");
    const Input input{std::istreambuf_iterator<char>(file), {}};
    std::snprintf(current.file.data(), current.file.size(), "%s", path.c_str());
    current.bytes = input.size();
    const std::size_t all = variants_of(input.size());
    const std::size_t runs = std::min(all, most);
    for (std::size_t run = 0; run < runs; ++run)
    {
        current.variant = run * all / runs; // Always includes 0, the unchanged file.
        const Input variant = changed(input, variant_of(current.variant, input.size()));
        const std::size_t accepted = accepted_inputs;
        LLVMFuzzerTestOneInput(variant.data(), variant.size());
        if (run == 0 && accepted_inputs == accepted &&
            !path.filename().string().starts_with("refused_"))
        {
            ++tally.useless_files;
            std::fprintf(stderr, "%s: is refused as it is\n", path.c_str());
        }
    }
    ++tally.files;
    tally.inputs += runs;
}

/// Error if a seed is refused, which makes it useless, or if there is none.
int run(std::size_t most, const std::vector<std::filesystem::path>& paths)
{
    Tally tally;
    for (const auto& folder : paths)
    {
        for (const auto& path : files_in(folder))
        {
            run_file(path, most, tally);
        }
    }
    std::printf("%zu files, %zu inputs, accepted %zu times\n", tally.files, tally.inputs,
                accepted_inputs);
    return tally.files > 0 && tally.useless_files == 0 ? 0 : 1;
}

} // namespace

} // namespace tactus::fuzz

int main(int argc, char** argv)
{
    std::size_t most = 0;
    const char* number = argc > 2 ? argv[1] : "";
    const auto read = std::from_chars(number, number + std::strlen(number), most);
    if (read.ec != std::errc{} || *read.ptr != '\0' || most == 0)
    {
        std::fputs("usage: run_corpus MOST PATH..., MOST being at least 1\n", stderr);
        return 3;
    }
    tactus::fuzz::listen_for_ends();
    return tactus::fuzz::run(most, {argv + 2, argv + argc});
}
