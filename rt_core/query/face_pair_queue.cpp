// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/face_pair_queue.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/placed_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tactus
{

namespace
{

/// Bound on the rounding of an object's vertex and of its difference from another one, as a share
/// of the larger distance from the centre: six times 2^-24.
constexpr float kVertexRounding = 0x1p-21F;
/// Bound on the relative rounding of a coordinate to single precision.
constexpr double kSingleRounding = 0x1p-23;

} // namespace

void FacePairQueue::add(const FacePair& pair, const PlacedBlock& tool, const BlockGeometry& block,
                        const VertexRows& rows, float slack) noexcept
{
    TACTUS_ASSERT(!is_full());
    const std::uint32_t to = count_++;
    const std::size_t first = block.corners[0][pair.lane];
    float farthest = 0.0F;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::size_t tool_row = tool.rows.corners[i][pair.tool_lane];
        const std::size_t row = block.corners[i][pair.lane];
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const float from = rows.at[axis][first];
            rows_.at[i][axis][to] = tool.rows.vertex[axis][tool_row] - from;
            rows_.at[3 + i][axis][to] = rows.at[axis][row] - from;
        }
        farthest = std::max(farthest, rows.size[row]);
    }
    rows_.off[to] = farthest * kVertexRounding + tool.off + slack + kLeastPairOff;
    pairs_[to] = pair;
}

void FacePairQueue::add(const FacePair& pair, const Triangle& tool, const Triangle& face,
                        double quantum_m) noexcept
{
    TACTUS_ASSERT(!is_full());
    const std::uint32_t to = count_++;
    double largest = 0.0;
    for (std::size_t i = 0; i < 6; ++i)
    {
        const Vec3 way = ((i < 3 ? tool[i] : face[i - 3]) - face[0]) / quantum_m;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double at = way[static_cast<Eigen::Index>(axis)];
            rows_.at[i][axis][to] = static_cast<float>(at);
            largest = std::max(largest, std::abs(at));
        }
    }
    rows_.off[to] = round_up_to_float(largest * kSingleRounding) + kLeastPairOff;
    pairs_[to] = pair;
}

} // namespace tactus
