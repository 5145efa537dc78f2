// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/volume.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/rounding.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace tactus::test
{

/// Interval along each of nine directions, rounded outward: x, y, z, then x + y, x - y, x + z, x -
/// z, y + z, y - z. The diagonals are not of unit length: their numbers are sqrt(2) times metres.
/// The default volume is empty.
struct Dop18
{
    static constexpr std::size_t kAxes = 3;
    static constexpr std::size_t kDirections = 9;
    static constexpr float kHuge = std::numeric_limits<float>::max();

    std::array<float, kDirections> low{kHuge, kHuge, kHuge, kHuge, kHuge,
                                       kHuge, kHuge, kHuge, kHuge};
    std::array<float, kDirections> high{-kHuge, -kHuge, -kHuge, -kHuge, -kHuge,
                                        -kHuge, -kHuge, -kHuge, -kHuge};

    constexpr bool operator==(const Dop18&) const noexcept = default;

    /// Volume of all points within `margin` >= 0, rounded outward. A step of length m changes a
    /// point's number along a direction by at most m x the direction's length: the margin on
    /// diagonals is m sqrt(2), rounded up to a float. No rounding in double can move that below the
    /// true product: for floats m and f of 24 bits, 2 m^2 and f^2 are different integers, so m
    /// sqrt(2) is at least 2^-49 of itself away from every float. The sums are then exact in double
    /// for the same reason as in Aabb::inflated(), and rounded outward.
    [[nodiscard]] constexpr Dop18 inflated(float margin) const noexcept
    {
        constexpr double kRootOfTwo = 1.4142135623730951;
        const auto along_axis = static_cast<double>(margin);
        const auto along_diagonal = static_cast<double>(round_up_to_float(along_axis * kRootOfTwo));
        Dop18 grown;
        for (std::size_t i = 0; i < kDirections; ++i)
        {
            const double wide = i < kAxes ? along_axis : along_diagonal;
            grown.low[i] = round_down_to_float(static_cast<double>(low[i]) - wide);
            grown.high[i] = round_up_to_float(static_cast<double>(high[i]) + wide);
        }
        return grown;
    }
};

/// Volume policy of the AB-Tree over 18-DOPs, like AabbVolume: a second volume, to show that the
/// tree depends on none. Its loops are in a separate source for the base instruction set; they
/// ignore the kernels, which know boxes only.
struct Dop18Volume
{
    using Box = Dop18;

    /// Intervals of the children, row by direction.
    struct Rows
    {
        std::array<std::array<float, kNodeChildren>, Dop18::kDirections> low{};
        std::array<std::array<float, kNodeChildren>, Dop18::kDirections> high{};

        [[nodiscard]] Dop18 get(std::uint32_t child) const noexcept
        {
            Dop18 volume;
            for (std::size_t i = 0; i < Dop18::kDirections; ++i)
            {
                volume.low[i] = low[i][child];
                volume.high[i] = high[i][child];
            }
            return volume;
        }
        void set(std::uint32_t child, const Dop18& volume) noexcept
        {
            for (std::size_t i = 0; i < Dop18::kDirections; ++i)
            {
                low[i][child] = volume.low[i];
                high[i][child] = volume.high[i];
            }
        }
    };

    /// Smallest volume, in floats, of the vertices in `mask`; `coordinates` are three rows of 16.
    [[nodiscard]] static Dop18 of_vertices(const Kernels& kernels, const float* coordinates,
                                           std::uint32_t mask) noexcept;

    /// Exact union of the children in `mask`.
    [[nodiscard]] static Dop18 of_children(const Kernels& kernels, const Rows& rows,
                                           std::uint32_t mask) noexcept;

    /// Lower bounds on the distances from the probe, in quanta: the greatest of the distances to
    /// the axis-aligned box and to each diagonal's slab. Returns the children in `mask` within
    /// `bound`. The true maximum exceeds a bound by at most 2^-19 of itself and 8 probe.slack.
    static std::uint32_t child_gaps(const Kernels& kernels, const Rows& rows,
                                    const KernelProbe& probe, std::uint32_t mask, float bound,
                                    float* gaps) noexcept;
};

} // namespace tactus::test
