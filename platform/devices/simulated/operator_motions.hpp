// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/motion_kind.hpp"
#include "platform/devices/simulated/operator_motion.hpp"
#include "platform/devices/simulated/scripted_operator.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <memory>

namespace tactus
{

/// A motion and the workspace that contains it.
struct MadeMotion
{
    std::unique_ptr<OperatorMotion> motion;
    Vec3 centre_world_m{Vec3::Zero()};
    double reach_m{0.0};
};

/// Refuses the scenes that ScriptedOperator refuses. The same scene and seed make the same motion,
/// bit for bit; only teleport and tremor use the seed.
[[nodiscard]] Result<MadeMotion, Refusal> make_motion(MotionKind kind, const OperatorScene& scene,
                                                      std::uint64_t seed = 1);

} // namespace tactus
