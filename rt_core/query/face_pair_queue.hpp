// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/node.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/triangle.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

struct BlockGeometry;
struct PlacedBlock;

/// A face of the tool and one of the object, as lanes of blocks in their trees.
struct FacePair
{
    std::uint32_t tool_block{kNoNode};
    std::uint32_t block{kNoNode};
    std::uint32_t tool_lane{0};
    std::uint32_t lane{0};

    bool operator==(const FacePair&) const noexcept = default;
};

/// Pairs of faces that wait until the kernels can process enough of them together.
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

    /// Adds a pair to a queue that is not full. `tool` is the tool's block, placed in the object's
    /// frame. `rows` are the vertices of the object's `block` around the centre of its box. `slack`
    /// is the rounding of the placement, in quanta.
    void add(const FacePair& pair, const PlacedBlock& tool, const BlockGeometry& block,
             const VertexRows& rows, float slack) noexcept TACTUS_NONBLOCKING;
    /// Adds a pair whose faces are both given in the object's frame, in metres.
    void add(const FacePair& pair, const Triangle& tool, const Triangle& face,
             double quantum_m) noexcept TACTUS_NONBLOCKING;

private:
    PairRows rows_; ///< Coordinates of the pairs. Lanes beyond the count hold old values.
    std::array<FacePair, kPairLanes> pairs_;
    std::uint32_t count_{0};
};

} // namespace tactus
