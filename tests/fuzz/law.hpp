// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/printable.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

/// Function that libFuzzer calls with each input; the plain build calls it from run_corpus.cpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace tactus::fuzz
{

/// Accepted inputs of each target: if all seeds are refused they are useless, and the fixed run
/// reports it.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): one target per program.
inline std::size_t accepted_inputs = 0;

/// Ends the program if a law that holds for every input is broken. `law` names the law.
inline void require(bool holds, const char* law)
{
    if (!holds)
    {
        std::fprintf(stderr, "broken law: %s\n", law);
        std::abort();
    }
}

/// True if a message is one line that a terminal can show, even if it quotes arbitrary bytes.
[[nodiscard]] inline bool is_one_clear_line(std::string_view text)
{
    return !text.empty() && printable_line(text) == text;
}

/// True if a refusal of a file begins with its name and continues in one clear line.
[[nodiscard]] inline bool is_clear_refusal(std::string_view text, std::string_view file)
{
    return text.starts_with(file) && is_one_clear_line(text.substr(file.size()));
}

} // namespace tactus::fuzz
