// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/hrtc/placement.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/pose.hpp"

namespace tactus::hrtc
{

/// Of a quaternion that is not zero, whatever its length; orthonormal to 2e-15.
[[nodiscard]] Mat3 rotation_of(const Pose& pose);

/// Where --place puts an object of this model, in the model's own frame.
[[nodiscard]] ObjectPose object_pose(const Placement& placement, const ModelHeader& header);

/// Where a host says that it stands: nothing of --place is left.
[[nodiscard]] ObjectPose object_pose(const Pose& pose, const ModelHeader& header);

} // namespace tactus::hrtc
