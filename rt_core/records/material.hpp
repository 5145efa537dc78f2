// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// How an object feels to a tool that touches it. A SceneChange with other values is
/// ChangeRefusal::bad_material.
struct Material
{
    /// The tool's or this, whichever is softer; > 0.
    double stiffness_n_per_m{kInfinity};
    /// Coulomb's coefficient while the tool sticks; 0 .. kFrictionMax.
    double static_friction{0.0};
    double dynamic_friction{0.0}; ///< While it slides; 0 .. the static one.
    /// Of the motion across the surface, in touch; 0 .. kDampingMax_n_s_per_m.
    double damping_n_s_per_m{0.0};
    /// Of the motion along the surface, in touch; 0 .. kDampingMax_n_s_per_m.
    double viscosity_n_s_per_m{0.0};
    /// Bumps of the surface, from trough to crest along an axis of the object; 0: it is smooth.
    /// At most kTextureSteepest of their length (force/texture.hpp).
    double texture_height_m{0.0};
    /// From crest to crest; where there are bumps kTextureLengthMin_m .. kTextureLengthMax_m.
    double texture_length_m{0.0};

    [[nodiscard]] bool operator==(const Material&) const noexcept = default;
};

/// Bumps that can be felt, or none; false for NaN, too.
[[nodiscard]] constexpr bool is_texture(double height_m, double length_m) noexcept
{
    const bool is_bumpy = height_m > 0.0 && length_m >= kTextureLengthMin_m &&
                          length_m <= kTextureLengthMax_m &&
                          height_m <= kTextureSteepest * length_m;
    return is_bumpy || (height_m == 0.0 && length_m >= 0.0 && length_m <= kTextureLengthMax_m);
}

/// Whether an object can feel so: within the ranges of Material; false for NaN, too.
[[nodiscard]] inline bool is_sound(const Material& material) noexcept
{
    return material.stiffness_n_per_m > 0.0 && material.static_friction >= 0.0 &&
           material.static_friction <= kFrictionMax && material.dynamic_friction >= 0.0 &&
           material.dynamic_friction <= material.static_friction &&
           material.damping_n_s_per_m >= 0.0 &&
           material.damping_n_s_per_m <= kDampingMax_n_s_per_m &&
           material.viscosity_n_s_per_m >= 0.0 &&
           material.viscosity_n_s_per_m <= kDampingMax_n_s_per_m &&
           is_texture(material.texture_height_m, material.texture_length_m);
}

} // namespace tactus
