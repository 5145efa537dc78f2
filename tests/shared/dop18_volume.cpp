// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Loops over 18-DOPs, four lanes at a time.

#include "tests/shared/dop18_volume.hpp"

#include "rt_core/abtree/block.hpp"
#include "rt_core/math/four_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kLanes = 4;

/// Diagonal direction: the sum of one axis and plus or minus another.
struct Diagonal
{
    std::size_t first;
    std::size_t second;
    float sign;
};
constexpr std::array<Diagonal, Dop18::kDirections - Dop18::kAxes> kDiagonals{
    {{0, 1, 1.0F}, {0, 1, -1.0F}, {0, 2, 1.0F}, {0, 2, -1.0F}, {1, 2, 1.0F}, {1, 2, -1.0F}}};

FourFloats load(const float* from) noexcept
{
    FourFloats value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

FourFloats splat(float value) noexcept
{
    return FourFloats{value, value, value, value};
}

FourFloats least(FourFloats a, FourFloats b) noexcept
{
    return a < b ? a : b;
}

FourFloats greatest(FourFloats a, FourFloats b) noexcept
{
    return a > b ? a : b;
}

float least_lane(FourFloats value) noexcept
{
    return std::min(std::min(value[0], value[1]), std::min(value[2], value[3]));
}

float greatest_lane(FourFloats value) noexcept
{
    return std::max(std::max(value[0], value[1]), std::max(value[2], value[3]));
}

/// Masks with all bits set in the lanes of set bits.
FourInts lanes_of(std::uint32_t mask) noexcept
{
    const FourInts bit{1, 2, 4, 8};
    return (static_cast<std::int32_t>(mask) & bit) != 0;
}

FourFloats square_root(FourFloats value) noexcept
{
    return FourFloats{std::sqrt(value[0]), std::sqrt(value[1]), std::sqrt(value[2]),
                      std::sqrt(value[3])};
}

/// Sum of floats with its exact rounding error (Knuth's six operations).
template <typename Float>
struct ExactSum
{
    Float sum;
    Float rest;
};

template <typename Float>
ExactSum<Float> exact_sum(Float a, Float b) noexcept
{
    const Float sum = a + b;
    const Float b_part = sum - a;
    const Float a_part = sum - b_part;
    return {sum, (a - a_part) + (b - b_part)};
}

/// Next lower float in lanes of `step_down`; a sum with a rest is never zero.
FourFloats stepped_down(FourFloats value, FourInts step_down) noexcept
{
    using FourWords = std::uint32_t __attribute__((vector_size(16)));
    const auto bits = reinterpret_cast<FourWords>(value); // Unused lanes may wrap.
    const FourWords below = value > splat(0.0F) ? bits - 1U : bits + 1U;
    return reinterpret_cast<FourFloats>(step_down ? below : bits);
}

/// Interval of one direction, widened by the values in `used`, each sum + rest. The least of values
/// rounded down is the least value, rounded down.
struct Interval
{
    FourFloats low = splat(Dop18::kHuge);
    FourFloats high = splat(-Dop18::kHuge);

    void add(FourFloats below, FourFloats above, FourInts used) noexcept
    {
        low = least(low, used ? below : splat(Dop18::kHuge));
        high = greatest(high, used ? above : splat(-Dop18::kHuge));
    }
    void write(Dop18& volume, std::size_t direction) const noexcept
    {
        volume.low[direction] = least_lane(low);
        volume.high[direction] = greatest_lane(high);
    }
};

void bound_axis(const float* row, std::uint32_t mask, std::size_t axis, Dop18& volume) noexcept
{
    Interval interval;
    for (std::uint32_t first = 0; first < kBlockVertices; first += kLanes)
    {
        const FourFloats value = load(row + first);
        interval.add(value, value, lanes_of(mask >> first));
    }
    interval.write(volume, axis);
}

void bound_diagonal(const float* coordinates, std::uint32_t mask, std::size_t which,
                    Dop18& volume) noexcept
{
    const Diagonal& diagonal = kDiagonals[which];
    Interval interval;
    for (std::uint32_t first = 0; first < kBlockVertices; first += kLanes)
    {
        const auto exact = exact_sum<FourFloats>(
            load(coordinates + kBlockVertices * diagonal.first + first),
            diagonal.sign * load(coordinates + kBlockVertices * diagonal.second + first));
        const FourFloats below = stepped_down(exact.sum, exact.rest < splat(0.0F));
        const FourFloats above = -stepped_down(-exact.sum, exact.rest > splat(0.0F));
        interval.add(below, above, lanes_of(mask >> first));
    }
    interval.write(volume, Dop18::kAxes + which);
}

/// Distances to the axis-aligned boxes of four children, computed like in the kernels: the root of
/// a sum of three rounded squares of rounded differences.
FourFloats axis_gaps(const Dop18Volume::Rows& rows, const KernelProbe& probe,
                     std::uint32_t first) noexcept
{
    constexpr float kShare = 1.0F - 0x1p-20F;
    FourFloats distance_sq = splat(0.0F);
    for (std::size_t axis = 0; axis < Dop18::kAxes; ++axis)
    {
        const FourFloats below =
            (load(&rows.low[axis][first]) - probe.high[axis]) - probe.low[axis];
        const FourFloats above =
            (probe.high[axis] - load(&rows.high[axis][first])) + probe.low[axis];
        const FourFloats gap = greatest(greatest(below, above), splat(0.0F)) * probe.scale;
        distance_sq += gap * gap;
    }
    return square_root(distance_sq) * kShare - probe.slack;
}

/// Coordinate of the probe along a diagonal, split like its coordinates, in metres.
struct DiagonalProbe
{
    float high;
    float low;
};
using DiagonalProbes = std::array<DiagonalProbe, kDiagonals.size()>;

DiagonalProbes diagonal_probes(const KernelProbe& probe) noexcept
{
    DiagonalProbes probes{};
    for (std::size_t i = 0; i < probes.size(); ++i)
    {
        const Diagonal& diagonal = kDiagonals[i];
        const auto exact =
            exact_sum(probe.high[diagonal.first], diagonal.sign * probe.high[diagonal.second]);
        const float low = probe.low[diagonal.first] + diagonal.sign * probe.low[diagonal.second];
        probes[i] = {exact.sum, exact.rest + low};
    }
    return probes;
}

/// Distances to four children's diagonal slabs: the greatest gap divided by sqrt(2).
///
/// Let L be the probe's largest coordinate. DiagonalProbe is right to 2^-45 L: its low part is a
/// sum of terms below 2^-22 L with three roundings, and the probe's own low parts leave 2^-48 L
/// each. The differences below add 2^-46 L and 2^-23 of the gap. Divided by sqrt(2) that is less
/// than 3 times the 2^-46 L of probe.slack; 4 are subtracted.
FourFloats diagonal_gaps(const Dop18Volume::Rows& rows, const DiagonalProbes& probes,
                         const KernelProbe& probe, std::uint32_t first) noexcept
{
    constexpr float kShare = 0x1.6a09e6p-1F * (1.0F - 0x1p-20F); // 1 / sqrt(2), rounded down.
    FourFloats gap = splat(0.0F);
    for (std::size_t i = 0; i < probes.size(); ++i)
    {
        const FourFloats low = load(&rows.low[Dop18::kAxes + i][first]);
        const FourFloats high = load(&rows.high[Dop18::kAxes + i][first]);
        gap = greatest(gap, (low - probes[i].high) - probes[i].low);
        gap = greatest(gap, (probes[i].high - high) + probes[i].low);
    }
    return gap * (probe.scale * kShare) - 4.0F * probe.slack;
}

} // namespace

Dop18 Dop18Volume::of_vertices(const Kernels& /*kernels*/, const float* coordinates,
                               std::uint32_t mask) noexcept
{
    Dop18 volume;
    for (std::size_t axis = 0; axis < Dop18::kAxes; ++axis)
    {
        bound_axis(coordinates + kBlockVertices * axis, mask, axis, volume);
    }
    for (std::size_t which = 0; which < kDiagonals.size(); ++which)
    {
        bound_diagonal(coordinates, mask, which, volume);
    }
    return volume;
}

Dop18 Dop18Volume::of_children(const Kernels& /*kernels*/, const Rows& rows,
                               std::uint32_t mask) noexcept
{
    Dop18 volume;
    for (std::size_t i = 0; i < Dop18::kDirections; ++i)
    {
        Interval interval;
        for (std::uint32_t first = 0; first < kNodeChildren; first += kLanes)
        {
            interval.add(load(&rows.low[i][first]), load(&rows.high[i][first]),
                         lanes_of(mask >> first));
        }
        interval.write(volume, i);
    }
    return volume;
}

std::uint32_t Dop18Volume::child_gaps(const Kernels& /*kernels*/, const Rows& rows,
                                      const KernelProbe& probe, std::uint32_t mask, float bound,
                                      float* gaps) noexcept
{
    const DiagonalProbes probes = diagonal_probes(probe);
    std::uint32_t near = 0;
    for (std::uint32_t first = 0; first < kNodeChildren; first += kLanes)
    {
        const FourFloats lower =
            greatest(axis_gaps(rows, probe, first), diagonal_gaps(rows, probes, probe, first));
        std::memcpy(gaps + first, &lower, sizeof lower);
        near |= bits_of(lower <= splat(bound)) << first;
    }
    return near & mask;
}

} // namespace tactus::test
