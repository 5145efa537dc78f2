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
    Vec3 approach_m{0.0, 0.0, 0.0}; ///< Expected displacement until a front is refined, 10 ms.
};

/// Pose of a pair's tool before its object, and the pair's range: the basis of its refinement,
/// prefetching and query. Model frame.
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

    /// Places the tool for this frame.
    void look(const ToolSpec& tool, const ToolPlacement& placement,
              const ObjectPose& pose) noexcept TACTUS_NONBLOCKING;
    /// Keeps the pair awake even if the last distance proves that nothing is in range.
    void wake() noexcept { is_asleep_ = false; }
    /// Keeps a query's answer for the present place.
    void remember(const DistanceAnswer& answer) noexcept TACTUS_NONBLOCKING;

    /// Core of the tool at its proxy.
    [[nodiscard]] const PlacedCore& core() const noexcept { return core_; }
    [[nodiscard]] const CoreCover& cover() const noexcept { return cover_; }
    [[nodiscard]] double reach_m() const noexcept { return reach_m_; }
    [[nodiscard]] const Vec3& approach_m() const noexcept { return approach_m_; }
    /// Proven out of range; no stage needs to check the pair.
    [[nodiscard]] bool is_asleep() const noexcept { return is_asleep_; }
    /// True if the place that the tool approaches is worth refining beside its present one.
    [[nodiscard]] bool looks_ahead() const noexcept TACTUS_NONBLOCKING;
    /// True if a surface is certainly so near that the front moves along with the tool, so that
    /// needs ahead arrive gradually. A first contact needs all at once.
    [[nodiscard]] bool is_near_surface() const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool has_known() const noexcept { return has_known_; }
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
    PlacedCore known_core_; ///< Core for which `known_` was answered.
    double motion_m_{0.0};  ///< Motion since then.
    DistanceAnswer known_;
};

} // namespace tactus
