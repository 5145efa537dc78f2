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
    float width_m{0.0F}; ///< Of the widest bracket; 0: every answer exact or decided.
    float frame_us{0.0F};
    std::array<float, kStages> stage_us{};

    void take(const SeriesPoint& other) noexcept;
    bool operator==(const SeriesPoint&) const noexcept = default;
};

/// A whole run as a few thousand points, however long it takes: each is the worst of `stride()`
/// frames, and when all places are taken neighbours become one. Filled by the haptic thread: no
/// allocation, and no frame merges more than one pair. Read by others once the loop has ended.
class RunSeries
{
public:
    static constexpr std::size_t kPoints = 2'048; ///< Two lists of 32 bytes each: 128 KiB.

    RunSeries() : now_(kPoints), before_(kPoints) {}

    void add(const SeriesPoint& frame) noexcept;

    /// Frames of each point, but for the last, which may have fewer. A power of two.
    [[nodiscard]] std::uint64_t stride() const noexcept { return stride_; }
    /// Oldest first.
    [[nodiscard]] std::vector<SeriesPoint> points() const;

private:
    [[nodiscard]] SeriesPoint merged(std::size_t pair) const noexcept;

    std::vector<SeriesPoint> now_;
    std::vector<SeriesPoint> before_;    ///< Points of half the stride,
    std::size_t unmerged_from_{kPoints}; ///< of which pairs from here on are not in `now_` yet.
    std::size_t used_{0};                ///< Points of `now_`, those included.
    std::uint64_t in_last_{0};           ///< Frames in the last point.
    std::uint64_t stride_{1};
};

} // namespace tactus::hrtc
