// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/pose.hpp"

namespace tactus::hrtc
{

/// A host's pose as the frame computes with it. The quaternion is not zero, whatever its length;
/// the rotation is orthonormal to 2e-15.
[[nodiscard]] Similarity to_similarity(const Pose& pose);

/// An object of this model that stands there, for the model's present revision.
[[nodiscard]] ObjectPose object_pose(const Similarity& place, const ModelHeader& header);

} // namespace tactus::hrtc
