// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/spm/error_code.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus
{

/// Largest error of faces that count as the surface for one pair. It exceeds the least allowed
/// value, up to a limit, while pools or budgets don't suffice for all faces in reach. It grows
/// after a few frames and shrinks slowly when there is capacity again, so that it doesn't
/// oscillate.
///
/// Haptic thread. The same frames give the same tolerances.
class SurfaceTolerance
{
public:
    /// Least and largest allowed tolerance; both 0: all faces must be exact.
    struct Range
    {
        ErrorCode least{0};
        ErrorCode most{0};
    };
    /// Capacity that the last frame found for the surface in reach.
    enum class Room : std::uint8_t
    {
        enough,  ///< A finer surface would fit, too.
        fitting, ///< The surface fits, or none is in reach.
        late,    ///< Splits are still missing.
        unknown, ///< Splits are still missing, and a mesh tool does not know the surface in reach.
        short_,  ///< Part of the surface did not fit.
    };

    /// Updates the tolerance, once per frame; least <= most. `is_served` is true if the last frame
    /// had nothing left to split.
    void fit(Range range, Room room, bool is_served) noexcept
    {
        TACTUS_ASSERT(range.least <= range.most);
        felt_ = is_served ? code_ : felt_;
        const bool is_wanting = room != Room::enough && room != Room::fitting;
        wanting_ = is_wanting ? wanting_ + (room == Room::late ? 1 : kShortWeight) : 0;
        calm_frames_ = room == Room::enough ? calm_frames_ + 1 : 0;
        std::uint32_t code = code_;
        if (wanting_ >= kPatience)
        {
            wanting_ = 0;
            code += kGrowth;
        }
        else if (calm_frames_ == kCalm)
        {
            calm_frames_ = 0;
            felt_ = code > range.least ? coarser(code, range) : felt_;
            code -= std::min(code, 1U);
        }
        code_ = static_cast<ErrorCode>(std::clamp<std::uint32_t>(code, range.least, range.most));
        felt_ = std::clamp(felt_, code_, range.most);
    }

    /// Tolerance of refinement.
    [[nodiscard]] ErrorCode code() const noexcept { return code_; }
    /// Tolerance of queries: code(), or up to twice the last one until a finer surface is complete.
    /// Faces that appear on the way may be that coarse.
    [[nodiscard]] ErrorCode felt() const noexcept { return felt_; }

    /// Largest factor by which the number of faces grows with one finer step of the tolerance;
    /// Room::enough means that so many fit.
    static constexpr double kFinerGrowth = 1.5;

private:
    [[nodiscard]] static ErrorCode coarser(std::uint32_t code, Range range) noexcept
    {
        return static_cast<ErrorCode>(std::min<std::uint32_t>(code + kGrowth, range.most));
    }

    /// Room::late frames after which the tolerance doubles; a front that only lags has caught up by
    /// then. A Room::unknown or Room::short_ frame counts kShortWeight times: merges of the
    /// previous step are done after six.
    static constexpr std::uint32_t kPatience = 24;
    static constexpr std::uint32_t kShortWeight = 4;
    static constexpr std::uint32_t kGrowth = 4;
    /// Consecutive Room::enough frames after which the tolerance shrinks by one code.
    static constexpr std::uint32_t kCalm = 30;

    ErrorCode code_{0};
    ErrorCode felt_{0};
    std::uint32_t wanting_{0};
    std::uint32_t calm_frames_{0};
};

} // namespace tactus
