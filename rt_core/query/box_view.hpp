// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/aabb.hpp"
#include "rt_core/query/mesh_placement.hpp"

#include <array>
#include <cstddef>

namespace tactus
{

/// View of the boxes of one frame from another frame, for the kernels, in units of the caller's
/// choice.
class BoxView
{
public:
    /// `there` is the placement of the boxes' frame in the viewing frame. `units_per_m` converts
    /// lengths of the viewing frame. `slack` covers rounding of the placement, in units.
    BoxView(const MeshPlacement& there, double units_per_m,
            float slack) noexcept TACTUS_NONBLOCKING;

    /// Places a box in the viewing frame. Its placed centre must be within kFarQuanta units of the
    /// origin. Takes about 20 ns.
    [[nodiscard]] KernelBox of(const Aabb& box) const noexcept TACTUS_NONBLOCKING;
    /// Axis number `along` of the boxes' frame, in the viewing frame.
    [[nodiscard]] const std::array<float, 3>& axis(std::size_t along) const noexcept
    {
        return axes_[along];
    }

private:
    using Axes = std::array<std::array<float, 3>, 3>;

    Axes axes_{};  ///< Axes of the boxes' frame, one after the other.
    Axes sizes_{}; ///< Absolute values of the axes' coordinates.
    MeshPlacement there_;
    double units_per_m_;
    float units_per_m_here_; ///< Factor for lengths in the boxes' own frame.
    float slack_;
};

} // namespace tactus
