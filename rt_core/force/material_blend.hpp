// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/material.hpp"

#include <algorithm>

namespace tactus
{

/// Blend of an object's material, as one tool feels it, from the old to the new one, linear over
/// kMaterialBlend_s. So the force changes by a small share of the difference per frame. If the
/// texture's length changes, the old bumps vanish before the new ones grow.
///
/// Haptic thread.
class MaterialBlend
{
public:
    MaterialBlend() noexcept = default;
    explicit MaterialBlend(const Material& material) noexcept
        : felt_(material), from_(material), to_(material)
    {
    }

    /// Moves the felt material by one frame of `elapsed_s` towards `wanted`; a wall is never felt
    /// stiffer than `tool_n_per_m`. True if the felt material changed.
    [[nodiscard]] bool step(const Material& wanted, double tool_n_per_m,
                            double elapsed_s) noexcept TACTUS_NONBLOCKING
    {
        if (wanted != to_)
        {
            from_ = felt_;
            to_ = wanted;
            gone_s_ = 0.0;
        }
        if (!(gone_s_ < kMaterialBlend_s))
        {
            return false;
        }
        gone_s_ += elapsed_s;
        const bool is_there = !(gone_s_ < kMaterialBlend_s);
        felt_ = is_there ? to_ : between(gone_s_ / kMaterialBlend_s, tool_n_per_m);
        return true;
    }

    [[nodiscard]] const Material& felt() const noexcept { return felt_; }

private:
    /// Linear interpolation like std::lerp, whose result may differ between libraries. Infinite if
    /// both ends are.
    [[nodiscard]] static double lerp(double from, double to, double share) noexcept
    {
        return from == to ? to : from + share * (to - from);
    }

    [[nodiscard]] Material between(double share, double tool_n_per_m) const noexcept
    {
        // A stiffness above the tool's isn't felt, and an infinite one can't be blended.
        const double stiffest =
            std::max(tool_n_per_m, std::min(from_.stiffness_n_per_m, to_.stiffness_n_per_m));
        Material felt;
        felt.stiffness_n_per_m = lerp(std::min(from_.stiffness_n_per_m, stiffest),
                                      std::min(to_.stiffness_n_per_m, stiffest), share);
        felt.static_friction = lerp(from_.static_friction, to_.static_friction, share);
        felt.dynamic_friction = std::min(lerp(from_.dynamic_friction, to_.dynamic_friction, share),
                                         felt.static_friction);
        felt.damping_n_s_per_m = lerp(from_.damping_n_s_per_m, to_.damping_n_s_per_m, share);
        felt.viscosity_n_s_per_m = lerp(from_.viscosity_n_s_per_m, to_.viscosity_n_s_per_m, share);
        if (from_.texture_length_m == to_.texture_length_m)
        {
            felt.texture_length_m = to_.texture_length_m;
            felt.texture_height_m = lerp(from_.texture_height_m, to_.texture_height_m, share);
            return felt;
        }
        const bool ends = share < 0.5;
        felt.texture_length_m = ends ? from_.texture_length_m : to_.texture_length_m;
        felt.texture_height_m = ends ? from_.texture_height_m * (1.0 - 2.0 * share)
                                     : to_.texture_height_m * (2.0 * share - 1.0);
        return felt;
    }

    Material felt_;
    Material from_;
    Material to_;
    double gone_s_{kMaterialBlend_s};
};

} // namespace tactus
