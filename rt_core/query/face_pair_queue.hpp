// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/block.hpp"
#include "rt_core/abtree/node.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/query/placed_blocks.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// Where a face of the tool and one of the object stand in their trees.
struct FacePair
{
    std::uint32_t tool_block{kNoNode};
    std::uint32_t block{kNoNode};
    std::uint32_t tool_lane{0};
    std::uint32_t lane{0};

    bool operator==(const FacePair&) const noexcept = default;
};

/// Pairs of faces that wait until there are enough for the kernels to look at together.
class FacePairQueue // NOLINT(cppcoreguidelines-pro-type-member-init): rows_ is written first.
{
public:
    [[nodiscard]] bool is_full() const noexcept { return count_ == kPairLanes; }
    [[nodiscard]] std::uint32_t size() const noexcept { return count_; }
    [[nodiscard]] const PairRows& rows() const noexcept { return rows_; }
    [[nodiscard]] const FacePair& operator[](std::uint32_t lane) const noexcept
    {
        TACTUS_ASSERT(lane < count_);
        return pairs_[lane];
    }
    void clear() noexcept { count_ = 0; }

    /// Not full. `tool` is the tool's block and `rows` are the object's `block`'s vertices around
    /// the centre of its box; `slack` is what placing rounds, in quanta.
    void add(const FacePair& pair, const PlacedBlock& tool, const BlockGeometry& block,
             const VertexRows& rows, float slack) noexcept TACTUS_NONBLOCKING;
    /// The same with both faces in the object's frame, in metres.
    void add(const FacePair& pair, const Triangle& tool, const Triangle& face,
             double quantum_m) noexcept TACTUS_NONBLOCKING;

private:
    PairRows rows_; ///< Lanes beyond the count hold what was there before.
    std::array<FacePair, kPairLanes> pairs_;
    std::uint32_t count_{0};
};

} // namespace tactus
