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

/// Goal of the hand and pose of the object in one frame.
struct Moment
{
    Vec3 goal_m{0.0, 0.0, 0.0};
    ObjectPose pose;
};

/// Hand and object with a sequence of random activities, each for some tens of frames: rest, slide
/// along the surface, tap through it, fly, jump; the object rotates about a place near the tool, or
/// is moved so that some place of its surface is at the goal.
class RandomMotion
{
public:
    /// Starts with an object of this scale. All arguments must outlive the motion.
    RandomMotion(const TestModel& model, const FaceTree& tree, double radius_m, double scale,
                 Random& random);

    /// Sets the greatest speed of taps, in the world at 1 kHz, which also determines their depth;
    /// without it they are 0.015 diag deep.
    void tap_up_to(double speed_m_per_s);

    [[nodiscard]] Moment next();
    /// Name of the present activity, for a report.
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
    double farthest_tap_m_{0.0}; ///< Greatest depth of a tap; 0: all are the same.
    Moment moment_;
    std::size_t activity_{0};
    std::uint32_t frame_{0}; ///< Frame of the activity.
    std::uint32_t frames_left_{0};

    std::optional<SurfaceSlide> slide_;
    double tap_m_{0.0};             ///< Half of the tap's path.
    Vec3 place_{0.0, 0.0, 0.0};     ///< Place of the hand, in the model frame.
    Vec3 direction_{0.0, 0.0, 0.0}; ///< Direction of a tap, or displacement per frame of a flight.
    Vec3 pivot_{0.0, 0.0, 0.0};     ///< Pivot of a rotation, in the model frame.
    Vec3 pivot_world_{0.0, 0.0, 0.0};
    Vec3 axis_{0.0, 0.0, 1.0};
    double rate_rad_{0.0};
    Mat3 rotation_before_{Mat3::Identity()};
};

/// Hand of RandomMotion over a resting object, with a sphere of 1 % of the model's diagonal. Model
/// and random numbers must outlive it, and it must stay at its address.
class WanderingOperator
{
public:
    WanderingOperator(const TestModel& model, Random& random);
    WanderingOperator(const WanderingOperator&) = delete;
    WanderingOperator& operator=(const WanderingOperator&) = delete;

    /// Place of the next frame, in the model frame.
    [[nodiscard]] Vec3 next();

private:
    FaceTree tree_;
    RandomMotion motion_;
};

} // namespace tactus::test
