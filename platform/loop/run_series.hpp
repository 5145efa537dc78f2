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

/// Maxima of some neighbouring frames.
struct SeriesPoint
{
    float force_n{0.0F}; ///< Largest force on a device.
    float width_m{0.0F}; ///< Widest bounds of an open or stale answer; 0: none was.
    float frame_us{0.0F};
    std::array<float, kStages> stage_us{};

    void take(const SeriesPoint& other) noexcept;
    bool operator==(const SeriesPoint&) const noexcept = default;
};

/// Position of a tool in that of some neighbouring frames with the most force.
struct PathPoint
{
    std::array<float, 3> place_m{}; ///< Position of the proxy, in the world.
    float force_n{0.0F};            ///< Force on the device.

    void take(const PathPoint& other) noexcept { *this = other.force_n > force_n ? other : *this; }
    bool operator==(const PathPoint&) const noexcept = default;
};

/// A whole run of any length as a few thousand points. Each merges `stride()` frames by
/// take(); once all points are used, neighbours merge. Filled by the haptic thread: no allocation,
/// and no frame merges more than one pair. Read by others once the loop has ended.
template <typename Point>
class Series
{
public:
    /// Capacity; two lists of these are 128 KiB of SeriesPoint.
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
    std::vector<Point> before_;          ///< Points of half the stride.
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
