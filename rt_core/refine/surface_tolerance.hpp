// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/spm/error_code.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus
{

/// How large the error of a face may be that counts as the surface for one pair: the least that is
/// allowed, or, where pools or budgets don't suffice for what is in reach, more, up to a limit. It
/// grows within some frames and shrinks slowly when there is room again, so that it doesn't swing.
///
/// Haptic thread. The same frames give the same tolerances.
class SurfaceTolerance
{
public:
    /// Codes of the least and the most; both 0: everything is to be exact.
    struct Range
    {
        ErrorCode least{0};
        ErrorCode most{0};
    };
    /// What the last frame found of the surface in reach.
    enum class Room : std::uint8_t
    {
        enough,  ///< For a surface that is finer, too.
        fitting, ///< Or nothing is in reach.
        late,    ///< What is to be split isn't yet.
        short_,  ///< Something of it had no room.
    };

    /// One frame; least <= most.
    void fit(Range range, Room room) noexcept
    {
        TACTUS_ASSERT(range.least <= range.most);
        const bool is_wanting = room == Room::short_ || room == Room::late;
        wanting_ = is_wanting ? wanting_ + (room == Room::short_ ? kShortWeight : 1) : 0;
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
            code -= std::min(code, 1U);
        }
        code_ = static_cast<ErrorCode>(std::clamp<std::uint32_t>(code, range.least, range.most));
    }

    [[nodiscard]] ErrorCode code() const noexcept { return code_; }

    /// A finer surface of this one is this much larger at most, and has to fit as well.
    static constexpr double kFinerGrowth = 1.5;

private:
    /// Frames in which something is late until the tolerance doubles: a front that only follows
    /// has caught up by then. One in which something is short counts as so many: what is merged
    /// because of the last time has gone after six.
    static constexpr std::uint32_t kPatience = 24;
    static constexpr std::uint32_t kShortWeight = 4;
    static constexpr std::uint32_t kGrowth = 4;
    /// Frames with room until it is a quarter of that smaller.
    static constexpr std::uint32_t kCalm = 30;

    ErrorCode code_{0};
    std::uint32_t wanting_{0};
    std::uint32_t calm_frames_{0};
};

} // namespace tactus
