// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/aabb.hpp"
#include "rt_core/query/other_surface.hpp"

#include <array>

namespace tactus
{

/// Boxes of one frame as seen from another one: for the kernels, in units shared by both frames.
class BoxView
{
public:
    /// `there` places the boxes' frame in the viewing frame. `units_per_m` applies to lengths in
    /// the viewing frame. `slack` covers rounding of the placement, in units.
    BoxView(const MeshPlacement& there, double units_per_m,
            float slack) noexcept TACTUS_NONBLOCKING;

    /// A box in the viewing frame. Its placed centre must be within kFarQuanta units of the origin.
    /// Takes about 20 ns.
    [[nodiscard]] KernelBox of(const Aabb& box) const noexcept TACTUS_NONBLOCKING;
    /// One of the boxes' own axes, in the viewing frame.
    [[nodiscard]] const std::array<float, 3>& axis(std::size_t along) const noexcept
    {
        return axes_[along];
    }

private:
    using Axes = std::array<std::array<float, 3>, 3>;

    Axes axes_{};  ///< Axes of the boxes' own frame, one after the other.
    Axes sizes_{}; ///< Absolute values of their coordinates.
    MeshPlacement there_;
    double units_per_m_;
    float units_per_m_here_; ///< Factor for lengths in the boxes' own frame.
    float slack_;
};

} // namespace tactus
