// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <optional>
#include <string>

namespace tactus::posix
{

/// Locks all present and future memory of the process. Returns nothing on success, or the line that
/// tells why it was refused and what would grant it; nothing stays locked then.
/// A finite limit that happens to suffice now is refused too: memory mapped later, a thread's stack
/// for instance, would fail. Before the loop: it brings all memory in.
[[nodiscard]] std::optional<std::string> lock_all_memory();

void unlock_all_memory() noexcept;

} // namespace tactus::posix
