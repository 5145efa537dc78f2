// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/local_surface.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/pose.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

// Any thread: these are values; those with vectors allocate.
namespace tactus
{

/// State of one tool at the end of a frame, in the controller's world.
struct ToolTelemetry
{
    std::array<double, 3> position_m{}; ///< Position of the device.
    /// Rotation of the device, unit quaternion x, y, z, w.
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};
    std::array<double, 3> proxy_m{};
    std::array<double, 4> proxy_rotation{0.0, 0.0, 0.0, 1.0};
    std::array<double, 3> force_n{};   ///< Force sent to the device.
    std::array<double, 3> torque_nm{}; ///< Torque sent to the device.
    double gripper_m{0.0};             ///< Opening of the gripper, if present.
    std::uint32_t buttons{0};          ///< Bit n: button n is pressed.
    bool has_gripper{false};
    bool in_contact{false};
    bool halted{false};
    bool over_constrained{false};
    bool data_limited{false};

    bool operator==(const ToolTelemetry&) const = default;
};

/// State of a pair: one tool and one object near it.
struct PairTelemetry
{
    /// Epoch of the server that shows the object; 0: placed by the controller.
    std::uint64_t server_epoch{0};
    /// Number of the object on its server, or on the controller if server_epoch is 0.
    std::uint32_t object{0};
    std::uint8_t tool{0};
    AnswerKind kind{AnswerKind::bounded};
    double lower_m{0.0}; ///< Proven lower bound of the distance between tool core and object.
    double upper_m{0.0}; ///< Proven upper bound of that distance; infinite while unknown.
    std::array<double, 3> point_m{}; ///< Nearest point on the object, in the world.
    /// Force of the tool on the object; estimated if the tool touches several objects.
    std::array<double, 3> force_n{};

    bool operator==(const PairTelemetry&) const = default;
};

/// Number of used slots and of all slots of one pool.
struct PoolTelemetry
{
    std::uint32_t used{0};
    std::uint32_t capacity{0};

    bool operator==(const PoolTelemetry&) const = default;
};

/// State of one model on a controller, and of the object that follows its server's poses.
struct ModelTelemetry
{
    /// Pages in use. The capacities of all four pools are 0 for a streamed model.
    PoolTelemetry pages;
    PoolTelemetry faces;
    PoolTelemetry blocks;
    PoolTelemetry nodes;
    ModelStage stage{ModelStage::resident};
    bool server_gone{false};
    bool is_static{false};       ///< True if the model is completely resident and refined.
    bool follows_poses{false};   ///< True if a server sets the pose of the object.
    std::int64_t pose_age_ns{0}; ///< Time since the server of the poses was last heard.
    std::uint64_t poses_refused{0};
    /// Index pages and chunks handed to the haptic thread since the start.
    std::uint64_t pieces{0};
    /// Mean time from a piece's request until its hand-over, since the last sample; 0: no piece.
    std::int64_t piece_wait_ns{0};

    bool operator==(const ModelTelemetry&) const = default;
};

/// Maximum number of models in Telemetry, which has those with the lowest numbers.
inline constexpr std::uint32_t kMaxShownModels = 8;

/// Length of the range of object numbers that one ObjectsTelemetry lists in full (sweep_begin),
/// besides the objects of awake pairs.
inline constexpr std::uint32_t kObjectSweep = 32;
/// Maximum number of objects in one ObjectsTelemetry.
inline constexpr std::size_t kMaxShownObjects = kObjectSweep + kMaxPairs;

/// State of one object at the end of a frame.
struct ObjectTelemetry
{
    /// Epoch of the server that shows the object; 0: placed by the controller.
    std::uint64_t server_epoch{0};
    std::uint32_t object{0}; ///< Number of the object on that server, or on the controller.
    std::uint32_t number{0}; ///< Number of the object on the controller.
    std::string name;        ///< Name of the object or else of its model; a printable_line().
    ContentHash model{};
    Pose pose; ///< Pose of the source mesh in the world.

    bool operator==(const ObjectTelemetry&) const = default;
};

/// Objects of awake pairs, and in turn those of kObjectSweep numbers.
struct ObjectsTelemetry
{
    /// Start of the range of object numbers, up to `sweep_end`, in which `objects` lists every
    /// object.
    std::uint32_t sweep_begin{0};
    std::uint32_t sweep_end{0};
    std::vector<ObjectTelemetry> objects;

    bool operator==(const ObjectsTelemetry&) const = default;
};

/// State at the end of one frame, and counts of frames since the start.
struct Telemetry
{
    std::uint64_t frame{0}; ///< Number of frames run.
    std::int64_t period_ns{0};
    std::int64_t time_ns{0}; ///< Start of the frame on the controller's clock.
    /// Frames whose worst answer was exact; the four counts below likewise for their kinds.
    std::uint64_t exact{0};
    std::uint64_t separated{0};
    std::uint64_t bounded{0};
    std::uint64_t stale{0};
    std::uint64_t within_tolerance{0};
    std::uint64_t missed{0};
    std::uint64_t overruns{0};
    std::uint64_t latency_misses{0};
    std::uint32_t faults_now{0};  ///< FrameFault bits of this frame.
    std::uint32_t faults_seen{0}; ///< FrameFault bits of all frames since the start.
    std::uint32_t tool_count{0};
    std::uint32_t pair_count{0};
    std::uint32_t model_count{0};
    std::array<ToolTelemetry, kMaxTools> tools{};
    std::array<PairTelemetry, kMaxPairs> pairs{}; ///< Awake pairs.
    std::array<ModelTelemetry, kMaxShownModels> models{};

    bool operator==(const Telemetry&) const = default;
};

static_assert(std::is_trivially_copyable_v<Telemetry>);
/// Bound of the time of the haptic thread, which copies a Telemetry into a mailbox each frame. If
/// the size grows, measure that time again and update this number and docs/architecture.md
/// ("Threads").
static_assert(sizeof(Telemetry) <= 8'752);

} // namespace tactus
