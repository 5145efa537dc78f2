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

/// Simulated operator that follows an object. It transforms the motion of another operator from the
/// object's pose at the start to its present pose. While the object rests, the motion is the same
/// bit for bit. After a jump the operator catches up by at most `step_max_m` a frame. Haptic
/// thread, between frames; allocates nothing.
class FollowingOperator final : public OperatorMotion
{
public:
    /// `objects` belong to the frame and must outlive the operator. `start` is the pose of the
    /// object's model when `hand` was made.
    FollowingOperator(std::unique_ptr<OperatorMotion> hand, const ObjectTable& objects,
                      std::uint32_t object, const Similarity& start, double step_max_m);

    [[nodiscard]] Vec3 start_world_m() const noexcept override { return hand_->start_world_m(); }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override;
    [[nodiscard]] OperatorGrip grip() const noexcept override;

private:
    /// Updates the object's displacement since the start. If the object isn't resident, it stays.
    void look() noexcept;

    std::unique_ptr<OperatorMotion> hand_;
    const ObjectTable& objects_;
    std::uint32_t object_;
    Similarity start_;
    double step_max_m_;
    Similarity way_; ///< Transform from the object's surroundings at the start to those now.
    bool has_moved_{false};
    Vec3 late_m_{Vec3::Zero()}; ///< Distance by which the operator lags.
};

} // namespace tactus::hrtc
