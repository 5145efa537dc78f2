// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/object_pose.hpp"
#include "rt_core/records/scene_change.hpp"
#include "rt_core/records/surface_edit.hpp"
#include "rt_core/records/work_budget.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// State of one tool that its device reports at the start of a frame. World frame, SI.
///
/// A sample is ignored, with FrameFault::tool_invalid, if a coordinate is kGoalRange_m or more, the
/// matrix is no rotation to kRotationTolerance, or the time is before the last sample's. A sample
/// with the last sample's time is ignored, too; FrameFault::tool_stuck reports this for longer than
/// kSampleHold_s.
struct ToolState
{
    Vec3 position_m{0.0, 0.0, 0.0}; ///< Centre of the tool at the device pose (the goal).
    /// Monotonic time of the sample; 0: the device reports no time.
    std::int64_t sample_time_ns{0};
    /// Whole periods since the last frame: above 1 after a stall; 0 counts as 1.
    std::uint32_t elapsed_periods{1};
    bool valid{true};                ///< False: no sample; the frame keeps the last one.
    Mat3 rotation{Mat3::Identity()}; ///< Rotation of the tool's frame.
};

/// Shape and limits of a tool, fixed when the frame is made. Values must be finite and not
/// negative, which a frame does not check. Recordings hold lengths up to 1e6 m and other values up
/// to 1e9.
struct ToolSpec
{
    double radius_m{0.0}; ///< The tool consists of all points within this distance of `core`.
    double stiffness_n_per_m{500.0}; ///< Stiffness of the virtual wall.
    double force_max_n{8.0};         ///< Limit of the force's norm.
    double speed_max_m_per_s{1.0};   ///< Speed limit of the proxy in contact.
    ToolCore core{PointCore{}};      ///< Core of the tool; with a point core the tool is a sphere.
    bool wants_contacts{false};      ///< Report contacts, normals and sides; microseconds per pair.
    double torque_max_nm{0.5};       ///< Limit of the torque's norm; a sphere has none.
    /// Query-only tool: it follows the device through surfaces, without a force.
    bool query_only{false};
    /// Stiffness of the rotational spring; 0: derived from the stiffness and the tool's size.
    double angular_stiffness_nm_per_rad{0.0};
    /// Width of the force shading of a point or sphere: facets within it round the contact feel
    /// like one smooth surface (force/force_shading.hpp). The felt surface is at most an eighth of
    /// the width off the mesh. kShadingWidthMin_m .. kShadingWidthMax_m; 0: off.
    double shading_m{0.0};
    /// Report exact distances at any range. Frames load and refine the surface for that gradually,
    /// after all that forces need; until then the bounds narrow. Some microseconds per pair and
    /// frame. No effect for a mesh tool.
    bool wants_distance{false};
    /// Report all pairs of faces that meet (MeshReport), for a mesh tool; about 30 us for 100
    /// pairs. False: at most kEnoughMeetingFaces pairs with `wants_contacts`, and one pair without.
    bool wants_pairs{false};
};

[[nodiscard]] inline bool is_mesh(const ToolSpec& tool) noexcept
{
    return std::holds_alternative<MeshCore>(tool.core);
}

/// Limits of one frame's work: recorded inputs, so a replay is exact. `nodes` and `triangles` are
/// per traversal; a frame has kFrameWalks traversals to refine and as many to query. `planes` are
/// per proxy, and kFrameWalks times as many per frame. Other limits are per frame.
struct Budgets
{
    std::uint32_t splits{64};       ///< Splits (K); at most kMaxSplitsPerFrame are used.
    std::uint32_t merges{64};       ///< Merges (K); at most kMaxMergesPerFrame are used.
    std::uint32_t scanned{512};     ///< Refined records checked for merging (S).
    std::uint32_t nodes{2'048};     ///< Tree nodes and blocks visited (N).
    std::uint32_t triangles{8'192}; ///< Triangles tested (P).
    std::uint32_t pages{8};         ///< Arrived pages adopted (A).
    std::uint32_t requests{32};     ///< Requests sent (Q).
    /// Index pages searched for chunks of ranked regions (G).
    std::uint32_t regions{8};
    /// Checks that the proxy of a sphere may do to find its path (F), about 1,300 instructions
    /// each. A check is one plane in double precision, eight in single precision, or a search among
    /// up to eight planes. Contacts where the proxy stops are always checked. Tools of other shapes
    /// need no checks.
    std::uint32_t planes{1'024};
    /// Work of the whole frame (W), in instructions as WorkCost counts them. Pairs of highest
    /// priority are served first, and a stage that is cut short reports a fault. Less than
    /// WorkBudget::kLeast counts as kLeast.
    std::uint32_t work{WorkBudget::kUnlimited};

    /// Factors on the work of a frame with a hull, or with a mesh, as a tool.
    static constexpr std::uint32_t kHullWork = 2;
    static constexpr std::uint32_t kMeshWork = 8;
    /// Work of a frame with `times` instructions per nanosecond of `frame_ns`, but at least
    /// least_work(times).
    [[nodiscard]] static constexpr std::uint32_t work_of(std::int64_t frame_ns,
                                                         std::uint32_t times) noexcept
    {
        return std::max(static_cast<std::uint32_t>(frame_ns) * times, least_work(times));
    }
    /// Least work with which a frame makes progress. `times` is 1, kHullWork or kMeshWork.
    [[nodiscard]] static constexpr std::uint32_t least_work(std::uint32_t times) noexcept
    {
        return times == 1 ? WorkBudget::kLeast : WorkBudget::kLeast * times * 3 / 2;
    }

    bool operator==(const Budgets&) const = default;
};

/// All inputs of a frame, besides the events of its models' queues: the same inputs give the same
/// bits. The spans are read during Frame::run() only.
struct FrameInput
{
    /// One state for each tool of the set-up (asserted); ignored for a removed tool.
    std::span<const ToolState> tools;
    std::span<const SceneChange> changes; ///< Applied first, in order; at most kMaxSceneChanges.
    Budgets budgets;
    std::int64_t now_ns{0}; ///< Time on the clock of ObjectPose::arrival_ns.
    /// Edits of models' surfaces, applied after `changes`, in order; at most kMaxEditsPerFrame.
    std::span<const SurfaceEdit> edits{}; // NOLINT(readability-redundant-member-init): for g++.
};

/// Stages of a frame, in order; each has a time in the report.
enum class Stage : std::uint8_t
{
    load,   ///< Adopt, predict, request; time T_L of the 3DIM 2005 paper.
    refine, ///< Coarsen, refine; time T_R.
    refit,  ///< Refit the AB-Trees; time T_B.
    query,  ///< Query distances; time T_Q.
    force,
};
inline constexpr std::uint32_t kStages = 5;
/// Names of the stages, in the order of Stage.
inline constexpr std::array<const char*, kStages> kStageNames{"load", "refine", "refit", "query",
                                                              "force"};
static_assert(static_cast<std::uint32_t>(Stage::force) + 1 == kStages);

/// Callback at the end of each stage, for the caller to take the time; the frame reads no clock.
struct StageMark
{
    using Function = void (*)(void* context, Stage stage) noexcept TACTUS_NONBLOCKING;

    Function function{nullptr};
    void* context{nullptr};

    void operator()(Stage stage) const noexcept
    {
        if (function != nullptr)
        {
            function(context, stage);
        }
    }
};

} // namespace tactus
