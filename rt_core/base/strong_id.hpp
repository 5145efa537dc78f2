// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <compare>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// A 32-bit id that can't be mistaken for another kind of id. `Tag` is never completed.
/// The largest value means "none", so ids themselves stay below 2^32 - 1.
template <typename Tag>
struct StrongId
{
    static constexpr std::uint32_t kNoneValue = 0xFFFF'FFFFU;

    std::uint32_t value{kNoneValue};

    [[nodiscard]] constexpr bool is_none() const noexcept { return value == kNoneValue; }
    // NOLINTNEXTLINE(modernize-use-nullptr): the check takes the comparison's zero for a pointer.
    constexpr auto operator<=>(const StrongId&) const noexcept = default;
};

} // namespace tactus
