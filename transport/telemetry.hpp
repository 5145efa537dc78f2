// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/local_surface.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

// Any thread: values; no call waits or allocates.
namespace tactus
{

/// One tool at the end of a frame, in the controller's world.
struct ToolTelemetry
{
    std::array<double, 3> position_m{};                 ///< Of the device.
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0}; ///< Likewise: unit quaternion x, y, z, w.
    std::array<double, 3> proxy_m{};
    std::array<double, 4> proxy_rotation{0.0, 0.0, 0.0, 1.0};
    std::array<double, 3> force_n{};   ///< That went to the device.
    std::array<double, 3> torque_nm{}; ///< Likewise.
    double gripper_m{0.0};             ///< How far it is open, where there is one.
    std::uint32_t buttons{0};          ///< Bit n: button n is pressed.
    bool has_gripper{false};
    bool in_contact{false};
    bool frozen{false};
    bool squeezed{false};
    bool held_back{false};

    bool operator==(const ToolTelemetry&) const = default;
};

/// One tool and one object near it.
struct PairTelemetry
{
    /// Of the host that shows the object; 0: it was placed by the controller.
    std::uint64_t host_epoch{0};
    std::uint32_t object{0}; ///< Its number on that host, or on the controller.
    std::uint8_t tool{0};
    AnswerKind kind{AnswerKind::bracket};
    double lower_m{0.0};             ///< Proven bounds of the distance from the tool's core.
    double upper_m{0.0};             ///< Infinite where nothing is known yet.
    std::array<double, 3> point_m{}; ///< Nearest on the object, in the world.
    std::array<double, 3> force_n{}; ///< By which the tool pushes the object; estimated where it
                                     ///< touches several.

    bool operator==(const PairTelemetry&) const = default;
};

/// One pool's slots.
struct PoolTelemetry
{
    std::uint32_t used{0};
    std::uint32_t capacity{0};

    bool operator==(const PoolTelemetry&) const = default;
};

/// One model on a controller, and the object that its host moves.
struct ModelTelemetry
{
    PoolTelemetry pages; ///< Here and below the capacity of one that comes and goes is 0.
    PoolTelemetry faces;
    PoolTelemetry blocks;
    PoolTelemetry nodes;
    ModelStage stage{ModelStage::resident};
    bool host_gone{false};
    bool is_static{false};       ///< All of it is there and refined.
    bool follows_poses{false};   ///< Its host shows it.
    std::int64_t pose_age_ns{0}; ///< Since its host was heard.
    std::uint64_t poses_refused{0};
    std::uint64_t pieces{0};       ///< Index pages and chunks handed over since the start.
    std::int64_t piece_wait_ns{0}; ///< From wish to hand-over: mean since the last sample; 0: none.

    bool operator==(const ModelTelemetry&) const = default;
};

/// Models that telemetry tells of: those of the least numbers.
inline constexpr std::uint32_t kMaxShownModels = 8;

/// What a controller tells of one frame and of all before it. Counts are frames since the start.
struct Telemetry
{
    std::uint64_t frame{0}; ///< Frames run.
    std::int64_t period_ns{0};
    std::int64_t time_ns{0}; ///< The frame's start on the controller's clock.
    std::uint64_t exact{0};  ///< By the frame's worst answer, and so on.
    std::uint64_t decided{0};
    std::uint64_t bracket{0};
    std::uint64_t stale{0};
    std::uint64_t within_tolerance{0};
    std::uint64_t missed{0};
    std::uint64_t own_faults{0};
    std::uint64_t machine_late{0};
    std::uint32_t faults_now{0};  ///< FrameFault bits of this frame.
    std::uint32_t faults_seen{0}; ///< Of any frame since the start.
    std::uint32_t tool_count{0};
    std::uint32_t pair_count{0};
    std::uint32_t model_count{0};
    std::array<ToolTelemetry, kMaxTools> tools{};
    std::array<PairTelemetry, kMaxPairs> pairs{}; ///< Those that are awake.
    std::array<ModelTelemetry, kMaxShownModels> models{};

    bool operator==(const Telemetry&) const = default;
};

static_assert(std::is_trivially_copyable_v<Telemetry>);
/// The haptic thread copies it into a mailbox in every frame, 8 bytes at a time;
/// docs/architecture.md
/// ("Threads") states what that costs. When more tools, objects or fields make it larger than this,
/// measure that cost again and raise the number here and the time there.
static_assert(sizeof(Telemetry) <= 8'752);

} // namespace tactus
