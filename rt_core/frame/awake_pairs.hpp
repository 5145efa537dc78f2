// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/frame/pair.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/query/pair_front.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

class ModelSet;

/// Pairs of tools and objects that are near each other, with their outputs and memory for further
/// pairs. Haptic thread. Cost: a frame sorts the pairs by priority and copies their outputs, at
/// most kMaxPairs.
class AwakePairs
{
public:
    /// Reserves memory for `most` pairs of these tools.
    AwakePairs(Arena& arena, std::span<const ToolSpec> tools, std::uint32_t most) noexcept;

    [[nodiscard]] std::uint32_t capacity() const noexcept
    {
        return static_cast<std::uint32_t>(pairs_.size());
    }
    /// All pairs, sorted by tool, then by object number.
    [[nodiscard]] std::span<Pair* const> all() const noexcept { return awake_.view(); }
    [[nodiscard]] std::span<Pair* const> of(std::uint32_t tool) const noexcept
    {
        return all().subspan(first_of_tool_[tool], first_of_tool_[tool + 1] - first_of_tool_[tool]);
    }
    /// All pairs, the highest priority first, as sorted by the last order().
    [[nodiscard]] std::span<Pair* const> by_priority() const noexcept { return order_.view(); }
    /// Sorts the pairs by priority; called after Pair::place() of each.
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
    /// Index of each tool's first pair in awake_.
    std::array<std::uint32_t, kMaxTools + 1> first_of_tool_{};
    StaticVector<Pair*, kMaxPairs> order_;
    std::array<PairOutput, kMaxPairs> outputs_{};
};

} // namespace tactus
