// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <optional>
#include <string>

namespace tactus::posix
{

/// Locks all present and future memory of the process. Returns nothing on success, or a line that
/// explains the refusal and how to avoid it; then nothing stays locked. A finite limit is refused
/// even if it suffices now: memory mapped later, a thread's stack for instance, would fail. Call
/// before the loop: it loads all memory.
[[nodiscard]] std::optional<std::string> lock_all_memory();

void unlock_all_memory() noexcept;

} // namespace tactus::posix
