// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/local_surface.hpp"

namespace tactus
{

/// Where a tool is in this frame, and how far it looks. World frame, SI.
struct ToolStance
{
    Similarity place;               ///< Of the tool's frame.
    double reach_m{0.0};            ///< From the core: what has to be exact for this frame's force.
    Vec3 approach_m{0.0, 0.0, 0.0}; ///< Expected way until a front would be refined, 10 ms.
};

/// Where a pair's tool is before its object, and how far the pair looks: what its refinement, its
/// prefetching and its query ask by. In the model's frame.
///
/// The distance from a tool to a surface changes by no more than the tool moves, so a proven L
/// stays of use: while L minus the motion is beyond what the tool asks for, the pair is asleep and
/// nothing has to be looked at. Haptic thread.
class Outlook
{
public:
    /// Records are merged when they are this much farther than the reach: between the two, nothing
    /// changes when a tool goes back and forth.
    static constexpr double kKeepFactor = 1.25;

    /// Places the tool for this frame.
    void look(const ToolSpec& tool, const ToolStance& stance,
              const ObjectPose& pose) noexcept TACTUS_NONBLOCKING;
    /// Looks even where the last distance proves that there is nothing to see.
    void wake() noexcept { is_asleep_ = false; }
    /// Keeps what a query found at the present place.
    void remember(const DistanceAnswer& answer) noexcept TACTUS_NONBLOCKING;

    /// The tool's, at its proxy now.
    [[nodiscard]] const PlacedCore& core() const noexcept { return core_; }
    [[nodiscard]] const CoreCover& cover() const noexcept { return cover_; }
    [[nodiscard]] double reach_m() const noexcept { return reach_m_; }
    [[nodiscard]] const Vec3& approach_m() const noexcept { return approach_m_; }
    /// Proven out of reach; no stage needs to look.
    [[nodiscard]] bool is_asleep() const noexcept { return is_asleep_; }
    /// Whether the place that the tool comes to is worth refining beside the one where it is.
    [[nodiscard]] bool looks_ahead() const noexcept TACTUS_NONBLOCKING;
    /// Whether a surface is surely so near that the front goes along with the tool: what lies ahead
    /// then comes bit by bit. The first contact needs all at once.
    [[nodiscard]] bool is_near_surface() const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool has_known() const noexcept { return has_known_; }
    /// The last answer, taken where the tool was then.
    [[nodiscard]] const DistanceAnswer& known() const noexcept { return known_; }
    /// What the last answer says of the present place, without looking: a valid bracket.
    [[nodiscard]] DistanceAnswer from_motion() const noexcept TACTUS_NONBLOCKING;

private:
    PlacedCore core_;
    CoreCover cover_;
    double reach_m_{0.0};
    Vec3 approach_m_{0.0, 0.0, 0.0};
    bool is_asleep_{false};
    bool has_known_{false};
    PlacedCore known_core_; ///< Where `known_` was taken, and
    double motion_m_{0.0};  ///< how far it has moved since.
    DistanceAnswer known_;
};

} // namespace tactus
