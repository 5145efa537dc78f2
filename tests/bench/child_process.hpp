// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/scenes.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace tactus::bench
{

struct ChildOutcome
{
    std::string text; ///< Return value of the work.
    /// Peak of resident memory, inherited memory included; 0 if the system does not report it.
    std::uint64_t peak_bytes{0};
};

/// Runs `work` in a child process and waits for it, so that its memory peak is its own. Its changes
/// are not visible to the caller, which must have no other threads. A failure if the work has one,
/// throws or is ended by a signal, or if the system grants no process.
[[nodiscard]] ChildOutcome run_in_child(const std::function<std::string()>& work);

} // namespace tactus::bench
