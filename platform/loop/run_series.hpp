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

/// The worst of some neighbouring frames.
struct SeriesPoint
{
    float force_n{0.0F}; ///< Largest on a device.
    float width_m{0.0F}; ///< Of the widest bracket; 0: no answer was open.
    float frame_us{0.0F};
    std::array<float, kStages> stage_us{};

    void take(const SeriesPoint& other) noexcept;
    bool operator==(const SeriesPoint&) const noexcept = default;
};

/// Where a tool was in the one of some neighbouring frames that had the most force.
struct PathPoint
{
    std::array<float, 3> place_m{}; ///< Where the proxy is, in the world.
    float force_n{0.0F};            ///< On the device.

    void take(const PathPoint& other) noexcept { *this = other.force_n > force_n ? other : *this; }
    bool operator==(const PathPoint&) const noexcept = default;
};

/// A whole run as a few thousand points, however long it takes: each is what its take() makes of
/// `stride()` frames, and when all places are taken neighbours become one. Filled by the haptic
/// thread: no allocation, and no frame merges more than one pair. Read by others once the loop has
/// ended.
template <typename Point>
class Series
{
public:
    static constexpr std::size_t kPoints = 2'048; ///< Two lists of these: 128 KiB of SeriesPoint.

    Series() : now_(kPoints), before_(kPoints) {}

    void add(const Point& frame) noexcept;

    /// Frames of each point, but for the last, which may have fewer. A power of two.
    [[nodiscard]] std::uint64_t stride() const noexcept { return stride_; }
    /// Oldest first.
    [[nodiscard]] std::vector<Point> points() const;

private:
    [[nodiscard]] Point merged(std::size_t pair) const noexcept;

    std::vector<Point> now_;
    std::vector<Point> before_;          ///< Points of half the stride,
    std::size_t unmerged_from_{kPoints}; ///< of which pairs from here on are not in `now_` yet.
    std::size_t used_{0};                ///< Points of `now_`, those included.
    std::uint64_t in_last_{0};           ///< Frames in the last point.
    std::uint64_t stride_{1};
};

using RunSeries = Series<SeriesPoint>;
using ToolPath = Series<PathPoint>;

extern template class Series<SeriesPoint>;
extern template class Series<PathPoint>;

} // namespace tactus::hrtc
