// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/aabb.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

inline constexpr std::uint32_t kNodeChildren = 8;
static_assert(kNodeChildren <= 8, "a node's masks are bytes");

/// A node's storage of its eight children's boxes, and the loops over boxes.
struct AabbVolume
{
    /// The children's boxes, row by axis, in the kernels' layout.
    struct Rows
    {
        std::array<std::array<float, kNodeChildren>, 3> low{};
        std::array<std::array<float, kNodeChildren>, 3> high{};

        [[nodiscard]] Aabb get(std::uint32_t child) const noexcept
        {
            return {{low[0][child], low[1][child], low[2][child]},
                    {high[0][child], high[1][child], high[2][child]}};
        }
        void set(std::uint32_t child, const Aabb& box) noexcept
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                low[axis][child] = box.low[axis];
                high[axis][child] = box.high[axis];
            }
        }
    };
    static_assert(sizeof(Rows) == sizeof(float) * 6 * kNodeChildren);

    /// Box of the vertices in `mask`; `coordinates` are three rows of 16.
    [[nodiscard]] static Aabb of_vertices(const Kernels& kernels, const float* coordinates,
                                          std::uint32_t mask) noexcept
    {
        std::array<float, 6> box{};
        kernels.block_box(coordinates, mask, box.data());
        return {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
    }

    /// Union of the boxes of the children in `mask`.
    [[nodiscard]] static Aabb of_children(const Kernels& kernels, const Rows& rows,
                                          std::uint32_t mask) noexcept
    {
        std::array<float, 6> box{};
        kernels.node_box(rows.low.front().data(), mask, box.data());
        return {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
    }

    /// Writes to `gaps` lower bounds on the children's distances from the probe, in quanta. Returns
    /// the children in `mask` whose bound is at most `bound`.
    static std::uint32_t child_gaps(const Kernels& kernels, const Rows& rows,
                                    const KernelProbe& probe, std::uint32_t mask, float bound,
                                    float* gaps) noexcept
    {
        return kernels.child_gaps(rows.low.front().data(), probe, mask, bound, gaps);
    }
    /// The same for distances from a box, in the box's units.
    static std::uint32_t child_gaps(const Kernels& kernels, const Rows& rows, const KernelBox& box,
                                    std::uint32_t mask, float bound, float* gaps) noexcept
    {
        return kernels.box_gaps(rows.low.front().data(), box, mask, bound, gaps);
    }
};

} // namespace tactus
