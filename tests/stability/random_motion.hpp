// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"
#include "tests/shared/test_model.hpp"

#include <array>
#include <optional>

namespace tactus::test
{

/// Where the hand holds the tool in one frame, and where the object stands.
struct Moment
{
    Vec3 goal_m{0.0, 0.0, 0.0};
    ObjectPose pose;
};

/// A hand and an object that do one thing after the other, chosen at random, each for some tens of
/// frames: rest, slide along the surface, tap through it, fly, jump; and the object spins about a
/// place near the tool, or is put elsewhere with any of its surface at the goal.
class RandomMotion
{
public:
    /// All of them must outlive the motion. The object has this scale.
    RandomMotion(const TestModel& model, const FaceTree& tree, double radius_m, double scale,
                 Random& random);

    /// Taps are as fast as this at most, in the world and at 1 kHz, and as far as that takes them;
    /// without it they are 0.015 diag deep.
    void tap_up_to(double speed_m_per_s);

    [[nodiscard]] Moment next();
    /// What is being done, for a report.
    [[nodiscard]] const char* activity() const { return kActivities[activity_].name; }

private:
    struct Activity
    {
        const char* name;
        void (RandomMotion::*begin)();
        void (RandomMotion::*go_on)();
    };
    static const std::array<Activity, 7> kActivities;

    void begin_nothing() {}
    void begin_slide();
    void begin_tap();
    void begin_flight();
    void begin_jump();
    void begin_spin();
    void carry_object();
    void rest() {}
    void slide();
    void tap();
    void fly();
    void spin();

    [[nodiscard]] Vec3 random_corner();
    void hold_at(const Vec3& place_m);

    const TestModel& model_;
    const FaceTree& tree_;
    double radius_m_;
    Random& random_;
    double farthest_tap_m_{0.0}; ///< 0: all are the same.
    Moment moment_;
    std::size_t activity_{0};
    std::uint32_t frame_{0}; ///< Of the activity.
    std::uint32_t frames_left_{0};

    std::optional<SurfaceSlide> slide_;
    double tap_m_{0.0};             ///< Half of its way.
    Vec3 place_{0.0, 0.0, 0.0};     ///< Of the hand, in the model's frame.
    Vec3 direction_{0.0, 0.0, 0.0}; ///< Of a tap or, times a step, of a flight.
    Vec3 pivot_{0.0, 0.0, 0.0};     ///< Of a spin, in the model's frame,
    Vec3 pivot_world_{0.0, 0.0, 0.0};
    Vec3 axis_{0.0, 0.0, 1.0};
    double rate_rad_{0.0};
    Mat3 rotation_before_{Mat3::Identity()};
};

/// The hand of RandomMotion over an object that stays where it is, held by a ball of 1 % of the
/// model's diagonal. Model and numbers must outlive it, and it must stay at its address.
class WanderingHand
{
public:
    WanderingHand(const TestModel& model, Random& random);
    WanderingHand(const WanderingHand&) = delete;
    WanderingHand& operator=(const WanderingHand&) = delete;

    /// The place of the next frame, in the model's frame.
    [[nodiscard]] Vec3 next();

private:
    FaceTree tree_;
    RandomMotion motion_;
};

} // namespace tactus::test
