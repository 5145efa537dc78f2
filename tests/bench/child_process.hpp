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
    std::string text; ///< What the work returned.
    /// Most memory that the child had resident at a time, what it inherited included; 0 when the
    /// system doesn't tell.
    std::uint64_t peak_bytes{0};
};

/// Runs `work` in a child process and waits for it, so that its peak of memory is its own. Nothing
/// that it changes is seen here. The caller must have no other threads. A failure when the work has
/// one, throws or is ended by a signal, and when the system grants no process.
[[nodiscard]] ChildOutcome run_in_child(const std::function<std::string()>& work);

} // namespace tactus::bench
