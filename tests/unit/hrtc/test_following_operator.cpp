// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/following_operator.hpp"
#include "rt_core/base/arena.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

namespace tactus::hrtc
{

namespace
{

/// Hand that keeps its last sense, and moves 1 mm along x each time.
struct StraightOperator final : public OperatorMotion
{
    OperatorSense* sensed;
    int frames{0};

    explicit StraightOperator(OperatorSense& into) : sensed(&into) {}
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return {1.0, 0.0, 0.0}; }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override
    {
        *sensed = sense;
        return {1.0 + 1e-3 * ++frames, 0.0, 0.0};
    }
    [[nodiscard]] OperatorGrip grip() const noexcept override
    {
        return {Mat3::Identity(), 5, std::nullopt};
    }
};

/// Object initially at (0, 0, 1), and the hand that follows it by up to 0.1 m a step.
struct Rig
{
    alignas(64) std::array<std::byte, 4096> memory{};
    Arena arena{memory};
    ObjectTable objects{arena, 1};
    OperatorSense sensed;
    Similarity start;
    std::unique_ptr<FollowingOperator> hand;

    Rig()
    {
        start.translation_m = {0.0, 0.0, 1.0};
        tell(SceneChangeKind::object_comes, start);
        hand = std::make_unique<FollowingOperator>(std::make_unique<StraightOperator>(sensed),
                                                   objects, 0, start, 0.1);
    }
    void tell(SceneChangeKind kind, const Similarity& place)
    {
        SceneChange change;
        change.kind = kind;
        static_cast<Similarity&>(change.pose) = place;
        objects.make(change, Vec3::Zero(), 1);
    }
    void move(const Similarity& place) { tell(SceneChangeKind::object_moves, place); }
};

/// Quarter turn about z.
Mat3 quarter()
{
    Mat3 rotation;
    rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    return rotation;
}

TEST(FollowingOperator, is_the_other_hand_while_the_object_stays)
{
    Rig rig;
    OperatorSense sense;
    sense.device_world_m = {0.1, 0.2, 0.3};
    EXPECT_EQ(rig.hand->start_world_m(), Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(rig.hand->next_world_m(sense), Vec3(1.001, 0.0, 0.0));
    EXPECT_EQ(rig.sensed.device_world_m, sense.device_world_m);
    EXPECT_EQ(rig.hand->grip().rotation, Mat3::Identity());
    EXPECT_EQ(rig.hand->grip().buttons, 5U);
}

TEST(FollowingOperator, goes_turns_and_grows_with_the_object)
{
    Rig rig;
    Similarity place = rig.start;
    place.translation_m = {0.0, 0.05, 1.0}; // Less than a step.
    place.rotation = quarter();
    place.scale = 2.0;
    rig.move(place);
    OperatorSense sense;
    sense.device_world_m = {0.0, 2.05, 1.0};
    sense.force_world_n = {0.0, 3.0, 0.0};
    // The point (x, 0, 0), one below the object, is now two below it and rotated to y.
    EXPECT_NEAR((rig.hand->next_world_m(sense) - Vec3(0.0, 0.05 + 2.002, -1.0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((rig.sensed.device_world_m - Vec3(1.0, 0.0, 1.0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((rig.sensed.force_world_n - Vec3(3.0, 0.0, 0.0)).norm(), 0.0, 1e-12);
    EXPECT_EQ(rig.hand->grip().rotation, quarter());
}

TEST(FollowingOperator, comes_after_a_jump_step_by_step)
{
    Rig rig;
    Similarity place = rig.start;
    place.translation_m.x() += 0.25;
    rig.move(place);
    Vec3 before = rig.hand->start_world_m();
    for (const double way_m : {0.1, 0.1, 0.05, 0.0, 0.0})
    {
        const Vec3 now = rig.hand->next_world_m({});
        EXPECT_NEAR((now - before).x(), way_m + 1e-3, 1e-12);
        before = now;
    }
    EXPECT_NEAR(before.x(), 1.0 + 0.25 + 5e-3, 1e-12);
}

TEST(FollowingOperator, stays_where_an_object_was_that_has_gone)
{
    Rig rig;
    Similarity place = rig.start;
    place.translation_m.x() += 0.05;
    rig.move(place);
    static_cast<void>(rig.hand->next_world_m({}));
    rig.tell(SceneChangeKind::object_goes, {});
    EXPECT_NEAR(rig.hand->next_world_m({}).x(), 1.052, 1e-12);
}

} // namespace

} // namespace tactus::hrtc
