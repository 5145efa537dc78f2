// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// One tool as its device reports it at the start of a frame. World frame, SI.
struct ToolState
{
    Vec3 position_m{0.0, 0.0, 0.0};   ///< Centre of the tool as the hand holds it (the goal).
    std::int64_t sample_time_ns{0};   ///< Monotonic time of the sample; 0: the device has none.
    std::uint32_t elapsed_periods{1}; ///< Whole periods since the last frame; more after a stall.
    bool valid{true};                 ///< False: no sample; the frame keeps the last one.
    Mat3 rotation{Mat3::Identity()};  ///< Of the tool's frame; orthonormal to 1e-6.
};

/// A tool's shape and what its device allows; fixed when the frame is made.
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
};

[[nodiscard]] inline bool is_mesh(const ToolSpec& tool) noexcept
{
    return std::holds_alternative<MeshCore>(tool.core);
}

/// Where an object stands: how the frame of its source mesh lies in the world. The default is where
/// the source stood. Inside the frame, from model_pose() on, it is that of the model's frame.
struct ObjectPose : Similarity
{
    std::int64_t stamp_ns{0};
    std::int64_t age_ns{0};    ///< Beyond FrameSetup::pose_age_max_ns the answers are called stale.
    std::uint32_t revision{0}; ///< Of the model that the pose was made for.
};

/// How an object feels to a tool that touches it.
struct Material
{
    /// The tool's or this, whichever is softer; > 0.
    double stiffness_n_per_m{kInfinity};
    double static_friction{0.0};   ///< Coulomb's coefficient while the tool sticks; >= 0.
    double dynamic_friction{0.0};  ///< While it slides; at most the static one.
    double damping_n_s_per_m{0.0}; ///< Of the motion across the surface, in touch; >= 0.
};

/// Which model an object shows, and how it feels; fixed when the frame is made.
struct ObjectSpec
{
    ModelId model{};
    Material material{};
};

/// The same for the frame of the model, whose origin the source mesh has at `origin_m`
/// (ModelHeader::origin_m).
[[nodiscard]] inline ObjectPose model_pose(const ObjectPose& source_pose,
                                           const Vec3& origin_m) noexcept
{
    ObjectPose pose = source_pose;
    pose.translation_m = source_pose.to_there(origin_m);
    return pose;
}

[[nodiscard]] inline Vec3 to_model(const ObjectPose& pose, const Vec3& world_m) noexcept
{
    return pose.to_here(world_m);
}

[[nodiscard]] inline Vec3 to_world(const ObjectPose& pose, const Vec3& model_m) noexcept
{
    return pose.to_there(model_m);
}

/// How far distances from a core of this radius round a place of the world may be off by its way
/// into the model's frame and back: see kPoseRounding.
[[nodiscard]] inline double pose_rounding_m(const ObjectPose& pose, const Vec3& world_m,
                                            double radius_m) noexcept
{
    TACTUS_ASSERT(radius_m >= 0.0);
    return kPoseRounding *
           ((world_m - pose.translation_m).norm() + world_m.norm() + 2.0 * radius_m);
}

/// What one frame may do at most. Inputs of the frame, chosen outside and recorded, so a replay is
/// exact. Counts are per model and frame, but `nodes` and `triangles` per pair and traversal.
struct Budgets
{
    std::uint32_t splits{64};       ///< K, at most kMaxSplitsPerFrame.
    std::uint32_t merges{64};       ///< K, at most kMaxMergesPerFrame.
    std::uint32_t scanned{512};     ///< S, refined records looked at for merging.
    std::uint32_t nodes{2'048};     ///< N, tree nodes and blocks visited.
    std::uint32_t triangles{8'192}; ///< P, triangles tested.
    std::uint32_t pages{8};         ///< A, arrivals adopted.
    std::uint32_t requests{32};     ///< Q, wishes sent.
    std::uint32_t regions{8}; ///< G, index pages searched for chunks that ranked regions need.
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
