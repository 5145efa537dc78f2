// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tactus::test
{

/// Directions of a volume's intervals, defined independently of the volume: its boxes have rows
/// `low` and `high` in this order.
template <typename Volume>
struct VolumeDirections;

template <>
struct VolumeDirections<AabbVolume>
{
    static constexpr std::array<std::array<int, 3>, 3> kAll{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

struct Dop18Volume;

template <>
struct VolumeDirections<Dop18Volume>
{
    static constexpr std::array<std::array<int, 3>, 9> kAll{{{1, 0, 0},
                                                             {0, 1, 0},
                                                             {0, 0, 1},
                                                             {1, 1, 0},
                                                             {1, -1, 0},
                                                             {1, 0, 1},
                                                             {1, 0, -1},
                                                             {0, 1, 1},
                                                             {0, 1, -1}}};
};

/// Boxes of any volume, computed one face and one direction at a time in extended precision.
template <typename Volume>
class VolumeOracle
{
public:
    using Box = typename Volume::Box;

    /// Widens a box to the least interval of floats along each direction that holds the point's
    /// number.
    static void widen(Box& box, const Vec3f& point)
    {
        for (std::size_t i = 0; i < kDirections.size(); ++i)
        {
            long double along = 0.0L; // Exact: two floats at most, and 64 bits.
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                along += kDirections[i][axis] * static_cast<long double>(point[axis]);
            }
            box.low[i] = std::min(box.low[i], float_below(along));
            box.high[i] = std::max(box.high[i], float_above(along));
        }
    }

    static void unite(Box& box, const Box& other)
    {
        for (std::size_t i = 0; i < kDirections.size(); ++i)
        {
            box.low[i] = std::min(box.low[i], other.low[i]);
            box.high[i] = std::max(box.high[i], other.high[i]);
        }
    }

    /// Grows a box by a length; along a direction multiplied by that direction's length, as the
    /// least float that is not below.
    [[nodiscard]] static Box grown(Box box, long double error_m)
    {
        for (std::size_t i = 0; i < kDirections.size(); ++i)
        {
            const auto& direction = kDirections[i];
            const int length_sq = direction[0] * direction[0] + direction[1] * direction[1] +
                                  direction[2] * direction[2];
            const auto margin = static_cast<long double>(
                float_above(error_m * std::sqrt(static_cast<long double>(length_sq))));
            box.low[i] = float_below(static_cast<long double>(box.low[i]) - margin);
            box.high[i] = float_above(static_cast<long double>(box.high[i]) + margin);
        }
        return box;
    }

private:
    static constexpr auto& kDirections = VolumeDirections<Volume>::kAll;
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    [[nodiscard]] static float float_below(long double value)
    {
        const auto nearest = static_cast<float>(value);
        return static_cast<long double>(nearest) > value ? std::nextafter(nearest, -kInfinity)
                                                         : nearest;
    }
    [[nodiscard]] static float float_above(long double value) { return -float_below(-value); }
};

} // namespace tactus::test
