// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/pose.hpp"

namespace tactus::hrtc
{

/// A host's pose in the frame's form. The quaternion must not be zero but may have any length; the
/// rotation is orthonormal to 2e-15.
[[nodiscard]] Similarity to_similarity(const Pose& pose);

/// Pose of an object of this model at `place`, for the model's present revision.
[[nodiscard]] ObjectPose object_pose(const Similarity& place, const ModelHeader& header);

} // namespace tactus::hrtc
