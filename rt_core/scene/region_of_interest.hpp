// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/local_surface.hpp"

namespace tactus
{

/// Pose and range of a tool in this frame. World frame, SI.
struct ToolPlacement
{
    Similarity place; ///< Pose of the tool's frame.
    /// Distance from the core within which the surface must be exact for this frame's force.
    double reach_m{0.0};
    Vec3 approach_m{0.0, 0.0, 0.0}; ///< Expected displacement in 10 ms, the time of refinement.
};

/// Core of a pair's tool in its object's model frame, and the range round it that matters: the
/// basis of refinement, prefetching and query.
///
/// The distance from a tool to a surface changes by no more than the tool moves, so a proven L
/// stays useful: while L minus the motion is beyond the pair's range, the pair is asleep and no
/// stage has to check it. Haptic thread.
class RegionOfInterest
{
public:
    /// Distance, in reaches, beyond which records are merged: up to it, a tool that moves back and
    /// forth changes nothing.
    static constexpr double kKeepFactor = 1.25;

    /// Sets the tool's place relative to the object, and the pair's range, for this frame.
    void update(const ToolSpec& tool, const ToolPlacement& placement,
                const ObjectPose& pose) noexcept TACTUS_NONBLOCKING;
    /// Keeps the pair awake even if the last distance proves that nothing is in range.
    void wake() noexcept { is_asleep_ = false; }
    /// Keeps a query's answer, which holds for the present place.
    void remember(const DistanceAnswer& answer) noexcept TACTUS_NONBLOCKING;

    /// Ends the validity of the last answer, since the surface has changed. It still shows where
    /// the surface was. Wakes the pair.
    void invalidate() noexcept
    {
        is_outdated_ = true;
        is_asleep_ = false;
    }

    /// Core of the tool at its proxy, in the model's frame.
    [[nodiscard]] const PlacedCore& core() const noexcept { return core_; }
    [[nodiscard]] const CoreCover& cover() const noexcept { return cover_; }
    [[nodiscard]] double reach_m() const noexcept { return reach_m_; }
    [[nodiscard]] const Vec3& approach_m() const noexcept { return approach_m_; }
    /// True if the pair is proven out of range, so that no stage has to check it.
    [[nodiscard]] bool is_asleep() const noexcept { return is_asleep_; }
    /// True if the approach is long enough to refine its end beside the present place.
    [[nodiscard]] bool looks_ahead() const noexcept TACTUS_NONBLOCKING;
    /// True if the last answer and the motion since prove a surface within kKeepFactor reaches. The
    /// front then moves along with the tool, and needs ahead arrive gradually; a first contact
    /// needs all at once.
    [[nodiscard]] bool is_near_surface() const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool has_known() const noexcept { return has_known_; }
    /// True if the last answer bounds the distance at the present place.
    [[nodiscard]] bool has_bounds() const noexcept { return has_known_ && !is_outdated_; }
    /// The last answer, for the tool's place at that time.
    [[nodiscard]] const DistanceAnswer& known() const noexcept { return known_; }
    /// Bounds for the present place from the last answer and the motion since.
    [[nodiscard]] DistanceAnswer from_motion() const noexcept TACTUS_NONBLOCKING;

private:
    PlacedCore core_;
    CoreCover cover_;
    double reach_m_{0.0};
    Vec3 approach_m_{0.0, 0.0, 0.0};
    bool is_asleep_{false};
    bool has_known_{false};
    bool is_outdated_{false}; ///< True if the surface has changed since the last answer.
    PlacedCore known_core_;   ///< Core for which `known_` was answered.
    double motion_m_{0.0};    ///< Motion of the core since then.
    DistanceAnswer known_;
};

} // namespace tactus
