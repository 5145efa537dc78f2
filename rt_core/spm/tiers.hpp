// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

namespace tactus
{

/// One past the last record of the tier that starts at `first`. Records are numbered in tiers,
/// coarsest first: 64 records, then in each tier four times as many as in all before it.
[[nodiscard]] constexpr std::uint64_t tier_end(std::uint64_t first) noexcept
{
    return first == 0 ? 64 : 5 * first;
}

} // namespace tactus
