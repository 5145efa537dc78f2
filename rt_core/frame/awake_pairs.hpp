// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/frame/model_set.hpp"
#include "rt_core/frame/pair.hpp"
#include "rt_core/limits.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// The pairs of tools and objects that are near each other, their outputs, and free places for new
/// pairs. Haptic thread.
class AwakePairs
{
public:
    /// Capacity for `most` pairs of such tools.
    AwakePairs(Arena& arena, std::span<const ToolSpec> tools, std::uint32_t most) noexcept;

    [[nodiscard]] std::uint32_t capacity() const noexcept
    {
        return static_cast<std::uint32_t>(pairs_.size());
    }
    /// Tool by tool; the pairs of a tool in order of the objects' numbers.
    [[nodiscard]] std::span<Pair* const> all() const noexcept { return awake_.view(); }
    [[nodiscard]] std::span<Pair* const> of(std::uint32_t tool) const noexcept
    {
        return all().subspan(first_of_tool_[tool], first_of_tool_[tool + 1] - first_of_tool_[tool]);
    }
    /// The pairs as order() sorted them, the highest priority first.
    [[nodiscard]] std::span<Pair* const> by_priority() const noexcept { return order_.view(); }
    /// Sorts the pairs; called after Pair::place() of each.
    void order() noexcept TACTUS_NONBLOCKING;

    /// Begins a pair; capacity must be left.
    void begin(const PairParts& parts) noexcept TACTUS_NONBLOCKING;
    /// Ends a pair and releases its closures in its models.
    void end(Pair& pair, ModelSet& models) noexcept TACTUS_NONBLOCKING;

    /// Copies the results of each pair into outputs() at the end of the frame.
    void report() noexcept TACTUS_NONBLOCKING;
    /// Outputs of the last report(), in the order of all().
    [[nodiscard]] std::span<const PairOutput> outputs() const noexcept
    {
        return std::span(outputs_).first(awake_.size());
    }

private:
    void lend_fronts() noexcept TACTUS_NONBLOCKING;
    void take_back_front(Pair& pair) noexcept TACTUS_NONBLOCKING;

    std::span<Pair> pairs_;
    PairMemory memory_;
    StaticVector<std::uint32_t, kMaxPairs> free_;
    StaticVector<PairFront*, PairFront::kFronts> free_fronts_;
    StaticVector<Pair*, kMaxPairs> awake_;
    std::array<std::uint32_t, kMaxTools + 1> first_of_tool_{}; ///< First pair of each tool.
    StaticVector<Pair*, kMaxPairs> order_;
    std::array<PairOutput, kMaxPairs> outputs_{};
};

} // namespace tactus
