// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstdint>

namespace tactus
{

/// What a hand knows when it decides where to go next: where the device is and what it pushes with.
struct HandSense
{
    std::uint64_t frame{0}; ///< Counts the decisions, from 1: frame 0 is the start itself.
    Vec3 device_world_m{Vec3::Zero()};
    Vec3 force_world_n{Vec3::Zero()};
};

/// The human end of a simulated device: a place that the hand pulls the device towards through its
/// own springiness. Depends on the senses alone, never on a clock.
class HandMotion
{
public:
    virtual ~HandMotion() = default;

    /// Where the hand and the device rest before the first frame.
    [[nodiscard]] virtual Vec3 start_world_m() const noexcept = 0;

    /// Where the hand is at the end of this frame. Called once a frame; allocates nothing.
    [[nodiscard]] virtual Vec3 next_world_m(const HandSense& sense) noexcept = 0;

protected:
    HandMotion() = default;
    HandMotion(const HandMotion&) = default;
    HandMotion& operator=(const HandMotion&) = default;
};

} // namespace tactus
