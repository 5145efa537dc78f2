// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace tactus::test
{

/// True if long trials are run in full: with TACTUS_TRIALS=full in the environment.
[[nodiscard]] inline bool has_full_trials()
{
    const char* text = std::getenv("TACTUS_TRIALS");
    return text != nullptr && std::string_view(text) == "full";
}

/// Length of a long trial, or its required count: all, or a quarter without full trials.
[[nodiscard]] inline std::uint32_t trial_length(std::uint32_t all)
{
    return has_full_trials() ? all : all / 4;
}

} // namespace tactus::test
