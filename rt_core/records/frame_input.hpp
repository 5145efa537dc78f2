// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/object_pose.hpp"
#include "rt_core/records/scene_change.hpp"
#include "rt_core/records/work_budget.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// State of one tool that its device reports at the start of a frame. World frame, SI.
///
/// A coordinate not below kGoalRange_m, a matrix that is no rotation to kRotationTolerance, or a
/// time before the last one's is FrameFault::tool_invalid, and the last sample stays. A sample with
/// the same time is not new: for longer than kSampleHold_s that is FrameFault::tool_stuck.
struct ToolState
{
    Vec3 position_m{0.0, 0.0, 0.0};   ///< Centre of the tool at the device pose (the goal).
    std::int64_t sample_time_ns{0};   ///< Monotonic time of the sample; 0: the device reports none.
    std::uint32_t elapsed_periods{1}; ///< Whole periods since the last frame; above 1 after a
                                      ///< stall. 0 counts as 1.
    bool valid{true};                 ///< False: no sample; the frame keeps the last one.
    Mat3 rotation{Mat3::Identity()};  ///< Rotation of the tool's frame.
};

/// A tool's shape and its device's limits; fixed when the frame is made. Values must be finite and
/// not negative, which a frame does not check; recordings hold lengths up to 1e6 m and other values
/// up to 1e9.
struct ToolSpec
{
    double radius_m{0.0};            ///< The tool is all within this distance of `core`.
    double stiffness_n_per_m{500.0}; ///< Stiffness of the virtual wall.
    double force_max_n{8.0};         ///< Limit of the force's norm.
    double speed_max_m_per_s{1.0};   ///< Speed limit of the proxy in contact.
    ToolCore core{PointCore{}};      ///< A point makes a sphere.
    bool wants_contacts{false};      ///< Report contacts, normals and sides; microseconds per pair.
    double torque_max_nm{0.5};       ///< Limit of the torque's norm; a sphere has none.
    /// Query-only tool: it follows the device through surfaces, without a force.
    bool query_only{false};
    /// Stiffness of the rotational spring; 0: derived from the stiffness and the tool's size.
    double angular_stiffness_nm_per_rad{0.0};
    /// Force shading of a point or sphere: facets within this distance of its contact are felt as
    /// one smooth surface, by interpolated normals (force/force_shading.hpp). The felt surface is
    /// within an eighth of it of the mesh. kShadingWidthMin_m .. kShadingWidthMax_m; 0: off.
    double shading_m{0.0};
    /// Report exact distances at any range, as soon as all of the surface that may be nearest is
    /// resident and refined. Frames refine it gradually, after all that forces need and as far as
    /// the pools have room; until then the bounds narrow. Some microseconds per pair and frame. No
    /// effect if the tool is a mesh.
    bool wants_distance{false};
    /// Report all pairs of faces that meet (MeshReport), if the tool is a mesh; about 30 us for 100
    /// pairs. Otherwise a tool that wants contacts gets kEnoughMeetingFaces, others the first pair
    /// found.
    bool wants_pairs{false};
};

[[nodiscard]] inline bool is_mesh(const ToolSpec& tool) noexcept
{
    return std::holds_alternative<MeshCore>(tool.core);
}

/// Limits of one frame's work. They are inputs, chosen outside and recorded, so a replay is exact.
/// Counts hold for the frame with all of its scene; `nodes` and `triangles` are those of one
/// traversal, of which a frame does kFrameWalks to refine and as many to answer; `planes` are those
/// of one proxy, with kFrameWalks times as many in all.
struct Budgets
{
    std::uint32_t splits{64};       ///< K; at most kMaxSplitsPerFrame are used.
    std::uint32_t merges{64};       ///< K; at most kMaxMergesPerFrame are used.
    std::uint32_t scanned{512};     ///< S, refined records checked for merging.
    std::uint32_t nodes{2'048};     ///< N, tree nodes and blocks visited.
    std::uint32_t triangles{8'192}; ///< P, triangles tested.
    std::uint32_t pages{8};         ///< A, arrivals adopted.
    std::uint32_t requests{32};     ///< Q, requests sent.
    /// G, index pages searched for chunks that ranked regions need.
    std::uint32_t regions{8};
    /// F, checks that the proxy of a sphere may do to find its path, about 1,300 instructions each:
    /// a plane against a triangle in double precision, eight in single precision, or a search among
    /// up to eight. A check that has begun is finished, and contacts where the proxy stops are
    /// checked in any case. Tools of other shapes need none: kMaxHalfSpaces bounds each of their
    /// steps.
    std::uint32_t planes{1'024};
    /// W, the whole frame in instructions (WorkCost), a bound on any frame. The highest-priority
    /// pairs are served first; a stage that is cut short reports it. At least WorkBudget::kLeast
    /// are used.
    std::uint32_t work{WorkBudget::kUnlimited};

    /// Factor by which a frame with a hull as a tool may do more work; below, with a mesh.
    static constexpr std::uint32_t kHullWork = 2;
    static constexpr std::uint32_t kMeshWork = 8;
    /// Work of `times` instructions per nanosecond that a frame may take, but at least what a frame
    /// needs.
    [[nodiscard]] static constexpr std::uint32_t work_of(std::int64_t frame_ns,
                                                         std::uint32_t times) noexcept
    {
        return std::max(static_cast<std::uint32_t>(frame_ns) * times, least_work(times));
    }
    /// Least work with which a frame makes progress: larger with large searches.
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
    std::span<const ToolState> tools;     ///< One for each tool of the set-up (asserted); ignored
                                          ///< for a removed tool.
    std::span<const SceneChange> changes; ///< Applied first, in order; at most kMaxSceneChanges.
    Budgets budgets;
    std::int64_t now_ns{0}; ///< Time on the clock of ObjectPose::arrival_ns.
};

/// The frame's stages, in order; times are named after them.
enum class Stage : std::uint8_t
{
    load,   ///< adopt, predict, request: T_L of the 3DIM 2005 paper
    refine, ///< coarsen, refine: T_R
    refit,  ///< T_B
    query,  ///< T_Q
    force,
};
inline constexpr std::uint32_t kStages = 5;
/// Names of the stages, in the order of Stage.
inline constexpr std::array<const char*, kStages> kStageNames{"load", "refine", "refit", "query",
                                                              "force"};
static_assert(static_cast<std::uint32_t>(Stage::force) + 1 == kStages);

/// Called at the end of each stage, so that the caller can take the time; the frame reads no clock.
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
