// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/pose.hpp"

#include <cmath>
#include <string>

// Any thread: values; their texts allocate.
namespace tactus
{

/// An object that a host shows to controllers.
struct ShownObject
{
    std::string name;    ///< Valid; for people, and for files of poses.
    ContentHash model{}; ///< Of a model that the host serves.
    Material material;
    Pose pose;
};

/// Whether a frame takes it.
[[nodiscard]] inline bool is_sound(const Material& material) noexcept
{
    return material.stiffness_n_per_m > 0.0 && std::isfinite(material.static_friction) &&
           material.dynamic_friction >= 0.0 &&
           material.dynamic_friction <= material.static_friction &&
           std::isfinite(material.damping_n_s_per_m) && material.damping_n_s_per_m >= 0.0;
}

} // namespace tactus
