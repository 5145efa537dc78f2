// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/operator_motion.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/scene/object_table.hpp"

#include <cstdint>
#include <memory>

namespace tactus::hrtc
{

/// A hand that goes where an object goes: another hand's motion round the object as it stood at the
/// start, taken to where it is now. While the object stays, that motion bit for bit; after a jump
/// the hand comes after at `speed_max_m_per_s`. Haptic thread, between frames; allocates nothing.
class FollowingOperator final : public OperatorMotion
{
public:
    /// `objects` are the frame's, and outlive the hand; `start` is where the object's model stood
    /// when `hand` was made.
    FollowingOperator(std::unique_ptr<OperatorMotion> hand, const ObjectTable& objects,
                      std::uint32_t object, const Similarity& start, double step_max_m);

    [[nodiscard]] Vec3 start_world_m() const noexcept override { return hand_->start_world_m(); }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override;
    [[nodiscard]] OperatorGrip grip() const noexcept override;

private:
    /// How far the object has gone since the start; as before where it isn't there.
    void look() noexcept;

    std::unique_ptr<OperatorMotion> hand_;
    const ObjectTable& objects_;
    std::uint32_t object_;
    Similarity start_;
    double step_max_m_;
    Similarity way_; ///< From what stood round the object at the start to the same round it now.
    bool has_moved_{false};
    Vec3 late_m_{Vec3::Zero()}; ///< By which the hand is behind.
};

} // namespace tactus::hrtc
