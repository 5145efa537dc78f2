// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tactus
{

/// One tool at the end of a frame, in the controller's world.
struct ToolTelemetry
{
    std::array<double, 3> position_m{}; ///< Of the device.
    std::array<double, 3> proxy_m{};
    std::array<double, 3> force_n{}; ///< That went to the device.
    std::array<double, 3> torque_nm{};
    bool in_contact{false};
    bool frozen{false};
    bool squeezed{false};
    bool held_back{false};
};

/// One pool's slots.
struct PoolTelemetry
{
    std::uint32_t used{0};
    std::uint32_t capacity{0};
};

/// One object and its model on a controller.
struct ModelTelemetry
{
    PoolTelemetry pages;
    PoolTelemetry faces;
    PoolTelemetry blocks;
    PoolTelemetry nodes;
    bool host_gone{false};
    bool is_static{false};       ///< All of it is there and refined.
    bool follows_poses{false};   ///< A pose has come; `pose_age_ns` says when.
    std::int64_t pose_age_ns{0}; ///< Since its arrival.
    std::uint64_t poses_refused{0};
    std::uint64_t pieces{0};       ///< Index pages and chunks handed over since the start.
    std::int64_t piece_wait_ns{0}; ///< From wish to hand-over: mean since the last sample; 0: none.
};

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
    std::uint64_t missed{0};
    std::uint64_t own_faults{0};
    std::uint64_t machine_late{0};
    std::uint32_t faults_now{0};  ///< FrameFault bits of this frame.
    std::uint32_t faults_seen{0}; ///< Of any frame since the start.
    std::uint32_t tool_count{0};
    std::uint32_t model_count{0};
    std::array<ToolTelemetry, kMaxTools> tools{};
    std::array<ModelTelemetry, kMaxObjects> models{};
};

static_assert(std::is_trivially_copyable_v<Telemetry>);
/// The haptic thread copies it into a mailbox in every frame, 8 bytes at a time;
/// docs/architecture.md
/// ("Threads") states what that costs. When more tools, objects or fields make it larger than this,
/// measure that cost again and raise the number here and the time there.
static_assert(sizeof(Telemetry) <= 1'280);

} // namespace tactus
