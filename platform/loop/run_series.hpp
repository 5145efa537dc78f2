// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::hrtc
{

/// Maxima over the frames of one point.
struct SeriesPoint
{
    float force_n{0.0F}; ///< Largest force on a device.
    float width_m{0.0F}; ///< Widest bounds of a bounded or stale answer; 0 without one.
    float frame_us{0.0F};
    std::array<float, kStages> stage_us{};

    void take(const SeriesPoint& other) noexcept;
    bool operator==(const SeriesPoint&) const noexcept = default;
};

/// Position of a tool in the frame with the most force, among the frames of one point.
struct PathPoint
{
    std::array<float, 3> place_m{}; ///< Position of the proxy, in the world.
    float force_n{0.0F};            ///< Force on the device.

    void take(const PathPoint& other) noexcept { *this = other.force_n > force_n ? other : *this; }
    bool operator==(const PathPoint&) const noexcept = default;
};

/// Series of at most kPoints points over a run of any length. A point merges `stride()` frames by
/// take(). When all points are used, neighbours are merged and the stride doubles. The haptic
/// thread fills the series: no allocation, and at most one merged pair a frame. Other threads read
/// it once the loop has ended.
template <typename Point>
class Series
{
public:
    /// Largest number of points; the two lists take 128 KiB of SeriesPoint.
    static constexpr std::size_t kPoints = 2'048;

    Series() : now_(kPoints), before_(kPoints) {}

    void add(const Point& frame) noexcept;

    /// Frames of each point, a power of two. The last point may have fewer.
    [[nodiscard]] std::uint64_t stride() const noexcept { return stride_; }
    /// Points, oldest first.
    [[nodiscard]] std::vector<Point> points() const;

private:
    [[nodiscard]] Point merged(std::size_t pair) const noexcept;

    std::vector<Point> now_;
    /// Points of half the stride, from before the last doubling.
    std::vector<Point> before_;
    std::size_t unmerged_from_{kPoints}; ///< First pair of `before_` that is not in `now_` yet.
    std::size_t used_{0};                ///< Points of `now_`, including unmerged ones.
    std::uint64_t in_last_{0};           ///< Frames in the last point.
    std::uint64_t stride_{1};
};

using RunSeries = Series<SeriesPoint>;
using ToolPath = Series<PathPoint>;

extern template class Series<SeriesPoint>;
extern template class Series<PathPoint>;

} // namespace tactus::hrtc
