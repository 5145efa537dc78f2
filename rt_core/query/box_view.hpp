// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/aabb.hpp"
#include "rt_core/query/other_surface.hpp"

#include <array>

namespace tactus
{

/// How boxes of one frame look from another one: for the kernels, in units that both frames share.
class BoxView
{
public:
    /// `there` is how the boxes' frame lies in the one that they are seen from; `units_per_m` is
    /// of lengths in the latter. `slack` covers, in units, what placing rounds.
    BoxView(const MeshPlacement& there, double units_per_m,
            float slack) noexcept TACTUS_NONBLOCKING;

    /// Its centre, placed, must be within kFarQuanta units of the origin. About 20 ns.
    [[nodiscard]] KernelBox of(const Aabb& box) const noexcept TACTUS_NONBLOCKING;
    /// One of the boxes' own axes, as they are seen.
    [[nodiscard]] const std::array<float, 3>& axis(std::size_t along) const noexcept
    {
        return axes_[along];
    }

private:
    using Axes = std::array<std::array<float, 3>, 3>;

    Axes axes_{};  ///< Of the boxes' own frame, one after the other.
    Axes sizes_{}; ///< Of their coordinates.
    MeshPlacement there_;
    double units_per_m_;
    float units_per_m_here_; ///< Of lengths in the boxes' own frame.
    float slack_;
};

} // namespace tactus
