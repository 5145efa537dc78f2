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

/// Simulated operator that follows an object: it carries the motion of another operator along from
/// the object's start pose to its present pose. While the object rests, the motion is the same bit
/// for bit. After a jump of the object the operator catches up by at most `step_max_m` a frame.
/// Haptic thread, between frames; allocates nothing.
class FollowingOperator final : public OperatorMotion
{
public:
    /// `objects`: table of the frame, which must outlive the operator. `object`: number of the
    /// followed object. `start`: the pose of the object's model when `motion` was made.
    FollowingOperator(std::unique_ptr<OperatorMotion> motion, const ObjectTable& objects,
                      std::uint32_t object, const Similarity& start, double step_max_m);

    [[nodiscard]] Vec3 start_world_m() const noexcept override { return motion_->start_world_m(); }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override;
    [[nodiscard]] OperatorGrip grip() const noexcept override;

private:
    /// Updates `way_` from the object's pose. If the object isn't resident, `way_` stays.
    void update_way() noexcept;

    std::unique_ptr<OperatorMotion> motion_;
    const ObjectTable& objects_;
    std::uint32_t object_;
    Similarity start_;
    double step_max_m_;
    /// Transform in the world that moves the object from its start to its present pose.
    Similarity way_;
    bool has_moved_{false};
    Vec3 late_m_{Vec3::Zero()}; ///< Offset of the operator from its goal after jumps, in the world.
};

} // namespace tactus::hrtc
