// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "tests/stability/tool_oracle.hpp"

namespace tactus::test
{

/// A place of the world in the model's frame, with no rounding that counts and by the inverse of
/// the rotation, which its transpose nearly is.
[[nodiscard]] inline WidePoint wide_place(const ObjectPose& pose, const Vec3& world_m)
{
    using WideMatrix = Eigen::Matrix<long double, 3, 3>;
    using WideVector = Eigen::Matrix<long double, 3, 1>;
    const WideMatrix rotation = pose.rotation.cast<long double>();
    const WideVector relative =
        world_m.cast<long double>() - pose.translation_m.cast<long double>();
    const WideVector place = rotation.inverse() * relative / static_cast<long double>(pose.scale);
    return {place.x(), place.y(), place.z()};
}

} // namespace tactus::test
