// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/frame/pair.hpp"
#include "rt_core/limits.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// The pairs of tools and objects that are near each other, and where the next ones have room.
class AwakePairs
{
public:
    AwakePairs() noexcept = default;
    /// Room for `most` pairs of such tools.
    AwakePairs(Arena& arena, std::span<const ToolSpec> tools, std::uint32_t most) noexcept;

    [[nodiscard]] std::uint32_t capacity() const noexcept
    {
        return static_cast<std::uint32_t>(pairs_.size());
    }
    /// Tool by tool, in each the objects by their numbers.
    [[nodiscard]] std::span<Pair* const> all() const noexcept { return awake_.view(); }
    [[nodiscard]] std::span<Pair* const> of(std::uint32_t tool) const noexcept
    {
        return all().subspan(first_of_tool_[tool], first_of_tool_[tool + 1] - first_of_tool_[tool]);
    }
    /// As order() left them, the most urgent first.
    [[nodiscard]] std::span<Pair* const> by_urgency() const noexcept { return order_.view(); }
    /// After Pair::place() of each.
    void order() noexcept TACTUS_NONBLOCKING;

    /// There must be room.
    void begin(const PairParts& parts) noexcept TACTUS_NONBLOCKING;
    void end(const Pair& pair) noexcept TACTUS_NONBLOCKING;

private:
    std::span<Pair> pairs_;
    PairMemory memory_;
    StaticVector<std::uint32_t, kMaxPairs> free_;
    StaticVector<Pair*, kMaxPairs> awake_;
    std::array<std::uint32_t, kMaxTools + 1> first_of_tool_{}; ///< Where each tool's begin.
    StaticVector<Pair*, kMaxPairs> order_;
};

} // namespace tactus
