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

/// One tool as its device reports it at the start of a frame. World frame, SI.
///
/// A coordinate that isn't below kGoalRange_m, a matrix that is no rotation to kRotationTolerance
/// or a time before the last one's is FrameFault::tool_invalid, and the last sample stays. One of
/// the same time isn't new: for longer than kSampleHold_s that is FrameFault::tool_stuck.
struct ToolState
{
    Vec3 position_m{0.0, 0.0, 0.0};   ///< Centre of the tool as the hand holds it (the goal).
    std::int64_t sample_time_ns{0};   ///< Monotonic time of the sample; 0: the device has none.
    std::uint32_t elapsed_periods{1}; ///< Whole periods since the last frame; more after a stall.
                                      ///< 0 counts as 1.
    bool valid{true};                 ///< False: no sample; the frame keeps the last one.
    Mat3 rotation{Mat3::Identity()};  ///< Of the tool's frame.
};

/// A tool's shape and what its device allows; fixed when the frame is made. Finite and not
/// negative, which a frame doesn't check; up to 1e6 m, and 1e9 of the rest, may be recorded.
struct ToolSpec
{
    double radius_m{0.0};            ///< The tool is everything within it of `core`.
    double stiffness_n_per_m{500.0}; ///< Of the virtual wall.
    double force_max_n{8.0};         ///< The force's norm is clamped to it.
    double speed_max_m_per_s{1.0};   ///< Faster goals are followed at this speed in contact.
    ToolCore core{PointCore{}};      ///< A point makes a sphere.
    bool wants_contacts{false};      ///< Contacts, normals and sides, some microseconds a pair.
    double torque_max_nm{0.5};       ///< The torque's norm is clamped to it. A sphere has none.
    /// Follows the hand through surfaces, without a force: a tool that measures.
    bool passes_through{false};
    /// Of the spring that turns the tool; 0: as the stiffness and the tool's own size make it.
    double angular_stiffness_nm_per_rad{0.0};
    /// A point or ball feels facets that lie within this of where it touches as one smooth surface,
    /// by normals that go over (force/smooth_normals.hpp); 0: it feels each. The surface that is
    /// felt is within an eighth of it of the mesh. kSmoothWidthMin_m .. kSmoothWidthMax_m.
    double smooth_m{0.0};
    /// Its pairs answer exactly however far they are, once the surface that may be the nearest is
    /// here and refined. Frames do that bit by bit, behind all that a force needs and as far as the
    /// pools have room; until then the bracket narrows. Some microseconds a pair and frame. Not of
    /// a tool that is a mesh: it changes nothing.
    bool wants_distance{false};
    /// Of a mesh: all pairs of faces that meet (MeshReport), some 30 us where 100 do. A tool that
    /// wants contacts gets kEnoughMeetingFaces in any case; of others the first that is found is
    /// told.
    bool wants_pairs{false};
};

[[nodiscard]] inline bool is_mesh(const ToolSpec& tool) noexcept
{
    return std::holds_alternative<MeshCore>(tool.core);
}

/// What one frame may do at most. Inputs of the frame, chosen outside and recorded, so a replay is
/// exact. Counts are the frame's, whatever is in the scene; `nodes` and `triangles` are those of
/// one traversal, of which a frame does kFrameWalks to refine and as many to answer; `planes` are
/// those of one proxy, and kFrameWalks times as many in all.
struct Budgets
{
    std::uint32_t splits{64};       ///< K; of more kMaxSplitsPerFrame are used.
    std::uint32_t merges{64};       ///< K; of more kMaxMergesPerFrame are used.
    std::uint32_t scanned{512};     ///< S, refined records looked at for merging.
    std::uint32_t nodes{2'048};     ///< N, tree nodes and blocks visited.
    std::uint32_t triangles{8'192}; ///< P, triangles tested.
    std::uint32_t pages{8};         ///< A, arrivals adopted.
    std::uint32_t requests{32};     ///< Q, wishes sent.
    std::uint32_t regions{8}; ///< G, index pages searched for chunks that ranked regions need.
    /// F, what the proxy of a ball looks at to find its way, some 1,300 instructions each: a plane
    /// before a triangle in double, eight in single precision, or a search among up to eight. What
    /// was begun is ended, and what touches where it stops is looked at whatever is left. Tools of
    /// other shapes need none: kMaxHalfSpaces bounds each of their steps.
    std::uint32_t planes{1'024};
    /// W, all of the frame in instructions (WorkCost): what bounds the frame whatever is in it. The
    /// most urgent pairs are served first; what is cut short says so. At least WorkBudget::kLeast
    /// are used.
    std::uint32_t work{WorkBudget::kUnlimited};

    /// With a tool that is a hull a frame may do so many times what others may, with a mesh so
    /// many.
    static constexpr std::uint32_t kHullWork = 2;
    static constexpr std::uint32_t kMeshWork = 8;
    /// `times` an instruction for each nanosecond that a frame may take, but what it needs in any
    /// case.
    [[nodiscard]] static constexpr std::uint32_t work_of(std::int64_t frame_ns,
                                                         std::uint32_t times) noexcept
    {
        return std::max(static_cast<std::uint32_t>(frame_ns) * times, least_work(times));
    }
    /// What a frame needs to get on: more with large searches.
    [[nodiscard]] static constexpr std::uint32_t least_work(std::uint32_t times) noexcept
    {
        return times == 1 ? WorkBudget::kLeast : WorkBudget::kLeast * times * 3 / 2;
    }

    bool operator==(const Budgets&) const = default;
};

/// All that a frame gets, beside what its models' doors bring: the same inputs give the same bits.
/// The spans are read during Frame::run() only.
struct FrameInput
{
    std::span<const ToolState> tools;     ///< One for each tool of the set-up (asserted); of one
                                          ///< that is gone it is not looked at.
    std::span<const SceneChange> changes; ///< In their order, before anything else; at most
                                          ///< kMaxSceneChanges are made.
    Budgets budgets;
    std::int64_t now_ns{0}; ///< On the clock of ObjectPose::arrival_ns.
};

/// The frame's stages, in order; times are named after them.
enum class Stage : std::uint8_t
{
    load,   ///< adopt, predict, request: T_L of the paper
    refine, ///< coarsen, refine: T_R
    refit,  ///< T_B
    query,  ///< T_Q
    force,
};
inline constexpr std::uint32_t kStages = 5;
/// In the order of Stage.
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
