// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tactus::bench
{

/// Reason, in one line, why a case cannot be run or has wrong answers. Thrown; ends the case.
class Failure : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

/// Value of a result; a failure if it was refused.
template <typename Value, typename Error>
Value needed(Result<Value, Error> result)
{
    if (!result)
    {
        throw Failure(result.error().text);
    }
    return std::move(result).value();
}

/// Ranges of the options.
inline constexpr std::uint32_t kMinFrames = 100;
inline constexpr std::uint32_t kMaxFrames = 1'000'000;
inline constexpr std::uint32_t kMaxPasses = 100;

struct BenchOptions
{
    bool quick{false};             ///< Fewer frames and repeats; no case of 4 M faces.
    bool full{false};              ///< All trials of a suite that usually runs few.
    bool count{false};             ///< One warm pass and nothing else, to count instructions.
    bool instructions{false};      ///< Counts instructions too, in suites that can.
    std::vector<std::string> only; ///< Names of cases; empty: all.
    std::filesystem::path cache;   ///< Folder that keeps encoded models; empty: none are kept.
    std::optional<std::uint32_t> frames; ///< Frames in place of the suite's own numbers.
    std::optional<std::uint32_t> passes;
    int core{-1}; ///< Core to measure on; -1: the last one that the process may use.

    [[nodiscard]] std::uint32_t frames_or(std::uint32_t usual, std::uint32_t quick_ones) const
    {
        return frames.value_or(quick ? quick_ones : usual);
    }
    [[nodiscard]] std::uint32_t passes_or(std::uint32_t usual, std::uint32_t quick_ones) const
    {
        return count ? 1 : passes.value_or(quick ? quick_ones : usual);
    }
};

/// Runs in which a case takes part.
enum class When : std::uint8_t
{
    always,
    full_only, ///< Not in quick runs, unless named.
    named_only,
};

[[nodiscard]] inline bool is_chosen(const BenchOptions& options, const std::string& name, When when)
{
    if (!options.only.empty())
    {
        return std::find(options.only.begin(), options.only.end(), name) != options.only.end();
    }
    return when == When::always || (when == When::full_only && !options.quick);
}

} // namespace tactus::bench
