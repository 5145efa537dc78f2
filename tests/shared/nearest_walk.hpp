// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/infinity.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/query/probe.hpp"
#include "rt_core/query/tree_walk.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tactus::test
{

/// Lower bound of a distance query, for a tree of any volume: the least distance minus error over
/// all faces, which is the distance for exact faces. It filters in float, decides in double at once
/// and begins at the last answer, so that volumes can be compared. No budget.
template <typename Tree>
class NearestWalk
{
public:
    /// Prepares for `tree`, which must be refitted and complete at each question, not deeper than
    /// the walk's stack, and outlive the walk.
    explicit NearestWalk(const Tree& tree) noexcept : tree_(tree) {}

    /// Least value within `band_m`, otherwise infinity; the band may be infinite. `point_m` is not
    /// is_beyond_kernels().
    [[nodiscard]] double least_m(const Vec3& point_m, double band_m) noexcept
    {
        begin(point_m, band_m);
        WalkBudget budget{kUnlimited, kUnlimited};
        TreeWalk walk(tree_, probe_, budget);
        const std::uint32_t warm = tree_.is_block_in_use(nearest_block_) ? nearest_block_ : kNoNode;
        if (warm != kNoNode)
        {
            test_block(warm);
        }
        for (std::uint32_t block = walk.next_block(limit_, false); block != kNoNode;
             block = walk.next_block(limit_, false))
        {
            if (block != warm)
            {
                test_block(block);
            }
        }
        visits_ += budget.nodes_visited;
        return least_m_ <= band_m ? least_m_ : kInfinity;
    }

    /// Nodes and blocks visited by all questions so far.
    [[nodiscard]] std::uint64_t visits() const noexcept { return visits_; }

private:
    void begin(const Vec3& point_m, double band_m) noexcept
    {
        const auto quantum = static_cast<double>(tree_.quantum_m());
        point_m_ = point_m;
        probe_ = make_probe(point_m, tree_.quantum_m());
        limit_ = band_m < kFarQuanta * quantum ? round_up_to_float(band_m / quantum)
                                               : std::numeric_limits<float>::infinity();
        least_m_ = kInfinity;
    }

    void test_block(std::uint32_t index) noexcept
    {
        const BlockGeometry& block = tree_.block(index);
        const BlockSide& side = tree_.side(index);
        const float limit_before = limit_;
        FaceBounds bounds;
        // Coarse faces can be nearer than their bounds by their error, so none is skipped here.
        const std::uint32_t near = tree_.kernels().face_bounds(
            block.coordinates.front().data(), block.corners.front().data(), probe_, block.faces,
            block.faces & ~std::uint32_t{side.coarse}, 0.0F, limit_, bounds);
        for (std::uint32_t lanes = near | side.coarse; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            // A difference of floats is right to 2^-24 of the error; the kernel's margin exceeds
            // that wherever it matters.
            const float error = error_in_quanta(side.errors[lane]);
            if (bounds.lower[lane] - error <= limit_)
            {
                decide(to_triangle(block_triangle(block, lane)), error);
            }
        }
        nearest_block_ = limit_ < limit_before ? index : nearest_block_;
    }

    void decide(const Triangle& triangle, float error_quanta) noexcept
    {
        const double distance_m =
            std::sqrt(closest_point_on_triangle(point_m_, triangle).distance_sq);
        least_m_ = std::min(least_m_, distance_m - static_cast<double>(error_quanta) *
                                                       static_cast<double>(tree_.quantum_m()));
    }

    static constexpr std::uint32_t kUnlimited = std::numeric_limits<std::uint32_t>::max();

    const Tree& tree_;
    Vec3 point_m_{0.0, 0.0, 0.0};
    KernelProbe probe_{};
    float limit_{0.0F}; ///< Limit in quanta: an exact face is not farther than this, or the band.
    double least_m_{0.0};
    std::uint32_t nearest_block_{kNoNode};
    std::uint64_t visits_{0};
};

} // namespace tactus::test
