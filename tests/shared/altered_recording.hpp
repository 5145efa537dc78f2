// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/recording.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tactus::test
{

/// The recording with `change` applied to one coded frame (its size, then its body) and valid
/// checksums: a sound recording of another run, which no damaged file can be.
[[nodiscard]] std::vector<std::byte>
alter_frame(const Recording& recording, std::uint64_t frame,
            const std::function<void(std::span<std::byte>)>& change);

/// Halves or doubles the x of the first tool's goal.
void change_goal(std::span<std::byte> coded_frame);

} // namespace tactus::test
