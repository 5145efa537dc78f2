// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/pose.hpp"

namespace tactus::hrtc
{

/// Similarity of a server's pose. The quaternion must not be zero but may have any length; the
/// rotation is orthonormal to 2e-15.
[[nodiscard]] Similarity to_similarity(const Pose& pose);

/// Pose at `place` of an object of the model with this header and its revision.
[[nodiscard]] ObjectPose object_pose(const Similarity& place, const ModelHeader& header);

} // namespace tactus::hrtc
