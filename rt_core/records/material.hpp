// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Material of an object, as a tool feels it. A SceneChange with values out of range is
/// ChangeRefusal::bad_material.
struct Material
{
    /// Stiffness above 0; the lower one of this and the tool's is used.
    double stiffness_n_per_m{kInfinity};
    /// Coulomb coefficient while the tool sticks; 0 .. kFrictionMax.
    double static_friction{0.0};
    /// Coulomb coefficient while the tool slides; 0 .. static_friction.
    double dynamic_friction{0.0};
    /// Damping of motion across the surface, in contact; 0 .. kDampingMax_n_s_per_m.
    double damping_n_s_per_m{0.0};
    /// Damping of motion along the surface, in contact; 0 .. kDampingMax_n_s_per_m.
    double viscosity_n_s_per_m{0.0};
    /// Height of bumps on the surface, from trough to crest along an axis of the object; 0: smooth.
    /// Its maximum is kTextureSteepest x texture_length_m (force/texture.hpp).
    double texture_height_m{0.0};
    /// Distance of the bumps from crest to crest. With bumps it must be in kTextureLengthMin_m ..
    /// kTextureLengthMax_m.
    double texture_length_m{0.0};

    [[nodiscard]] bool operator==(const Material&) const noexcept = default;
};

/// True if the texture is within its limits or absent; false for NaN.
[[nodiscard]] constexpr bool is_texture(double height_m, double length_m) noexcept
{
    const bool is_bumpy = height_m > 0.0 && length_m >= kTextureLengthMin_m &&
                          length_m <= kTextureLengthMax_m &&
                          height_m <= kTextureSteepest * length_m;
    return is_bumpy || (height_m == 0.0 && length_m >= 0.0 && length_m <= kTextureLengthMax_m);
}

/// True if a material is within the ranges of Material; false for NaN.
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
