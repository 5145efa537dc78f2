// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/scene_mailbox.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace tactus
{
namespace
{

constexpr Duration kLimit = milliseconds(100);
constexpr MonotonicTime kStart{1'000'000'000};

/// Pose with one number in every field except the rotation, which is about z.
ObjectPose pose_of(double number)
{
    ObjectPose pose;
    pose.rotation = Eigen::AngleAxisd(number, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.translation_m = Vec3(number, number, number);
    pose.scale = number;
    pose.stamp_ns = static_cast<std::int64_t>(number);
    return pose;
}

bool is_whole(const ObjectPose& pose)
{
    const double number = pose.scale;
    return pose.rotation == pose_of(number).rotation &&
           pose.translation_m == pose_of(number).translation_m &&
           pose.stamp_ns == pose_of(number).stamp_ns;
}

TEST(SceneMailbox, tells_of_what_moved_and_of_nothing_else)
{
    SceneMailbox sut(std::vector{pose_of(1.0), pose_of(2.0)}, kLimit);
    sut.put(1, pose_of(5.0), kStart);
    const auto changes = sut.refresh(kStart);
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes[0].kind, SceneChangeKind::object_moves);
    EXPECT_EQ(changes[0].number, 1U);
    EXPECT_EQ(changes[0].generation, 0U);
    EXPECT_EQ(changes[0].pose.scale, 5.0);
    EXPECT_TRUE(is_whole(changes[0].pose));
    EXPECT_FALSE(sut.uses()[0].is_followed);
    EXPECT_TRUE(sut.uses()[1].is_followed);
    EXPECT_TRUE(sut.refresh(kStart + milliseconds(1)).empty());
}

TEST(SceneMailbox, counts_the_age_from_when_the_server_was_heard_on_its_own_clock)
{
    SceneMailbox sut(std::vector{pose_of(1.0)}, kLimit);
    ObjectPose pose = pose_of(2.0);
    pose.stamp_ns = 1; // Any clock of the server.
    pose.arrival_ns = 77;
    sut.put(0, pose, kStart);
    const auto changes = sut.refresh(kStart + milliseconds(3));
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes[0].pose.arrival_ns, 0); // The pose does not age while the server is heard.
    EXPECT_EQ(changes[0].pose.stamp_ns, 1);
    static_cast<void>(sut.refresh(kStart + kLimit));
    EXPECT_EQ(sut.uses()[0].old_frames, 0U);
    static_cast<void>(sut.refresh(kStart + kLimit + nanoseconds(1)));
    EXPECT_EQ(sut.uses()[0].old_frames, 1U);
    EXPECT_EQ(sut.uses()[0].age_max.ns, kLimit.ns + 1);
    sut.note_heard(0, kStart + milliseconds(200));
    static_cast<void>(sut.refresh(kStart + milliseconds(201)));
    EXPECT_EQ(sut.uses()[0].old_frames, 1U);
}

TEST(SceneMailbox, tells_the_frame_of_a_silent_server_before_the_limit_and_of_one_that_is_back)
{
    SceneMailbox sut(std::vector{pose_of(1.0)}, kLimit);
    sut.put(0, pose_of(2.0), kStart);
    ASSERT_EQ(sut.refresh(kStart).size(), 1U);
    for (int ms = 20; ms <= 200; ms += 20) // The object rests, and its server is heard: no changes.
    {
        sut.note_heard(0, kStart + milliseconds(ms));
        EXPECT_TRUE(sut.refresh(kStart + milliseconds(ms + 15)).empty());
    }
    EXPECT_TRUE(sut.refresh(kStart + milliseconds(250)).empty());
    const auto silent = sut.refresh(kStart + milliseconds(251));
    ASSERT_EQ(silent.size(), 1U);
    EXPECT_EQ(silent[0].pose.arrival_ns, (kStart + milliseconds(200)).ns);
    EXPECT_EQ(silent[0].pose.scale, 2.0);
    EXPECT_TRUE(sut.refresh(kStart + milliseconds(400)).empty()); // The frame continues by itself.
    sut.note_heard(0, kStart + milliseconds(401));
    const auto back = sut.refresh(kStart + milliseconds(402));
    ASSERT_EQ(back.size(), 1U);
    EXPECT_EQ(back[0].pose.arrival_ns, 0);
    EXPECT_EQ(sut.uses()[0].moves, 1U);
}

TEST(SceneMailbox, takes_what_came_after_the_frame_began_as_new)
{
    SceneMailbox sut(std::vector{pose_of(1.0)}, kLimit);
    sut.put(0, pose_of(2.0), kStart + microseconds(5));
    EXPECT_EQ(age_ns(sut.refresh(kStart)[0].pose, kStart.ns), 0);
    EXPECT_EQ(sut.uses()[0].age_max.ns, 0);
}

/// Pose at x that is rotated about z by 10 x, stamped by the server's clock.
ObjectPose pose_at(double x_m, Duration stamp)
{
    ObjectPose pose;
    pose.translation_m = Vec3(x_m, 0.0, 0.0);
    pose.rotation = Eigen::AngleAxisd(10.0 * x_m, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.stamp_ns = stamp.ns;
    return pose;
}

/// 100 poses a second at 0.1 m/s, with irregular arrival: each frame's step is as small as the
/// motion, and no step exceeds the server's poses.
TEST(SceneMailbox, lets_an_object_glide_from_pose_to_pose_over_the_time_between_them)
{
    SceneMailbox sut(std::vector{pose_at(0.0, {})}, kLimit);
    sut.put(0, pose_at(0.0, milliseconds(5)), kStart);
    static_cast<void>(sut.refresh(kStart));
    double last_m = 0.0;
    double said_m = 0.0;
    for (int ms = 10; ms < 500; ++ms)
    {
        const MonotonicTime now = kStart + milliseconds(ms);
        if (ms == 10)
        {
            static_cast<void>(sut.refresh(now - milliseconds(1)));
        }
        if (ms % 10 == (ms / 10) % 2) // 9 and 11 ms apart in turns.
        {
            const int pose = ms / 10;
            said_m = 1e-3 * pose;
            sut.put(0, pose_at(said_m, milliseconds(5 + 10 * pose)), now);
        }
        for (const SceneChange& change : sut.refresh(now))
        {
            const Similarity& at = change.pose;
            EXPECT_LE(at.translation_m.x(), said_m);
            EXPECT_GE(at.translation_m.x(), last_m);
            EXPECT_LT(at.translation_m.x() - last_m, 1.25e-4) << ms;
            const Mat3 unturned = at.rotation.transpose() * at.rotation;
            EXPECT_LT((unturned - Mat3::Identity()).norm(), 1e-14);
            EXPECT_NEAR(std::asin(at.rotation(1, 0)), 10.0 * at.translation_m.x(), 1e-7);
            last_m = at.translation_m.x();
        }
    }
    EXPECT_GT(last_m, 0.045);
}

/// 100 poses a second, each delayed by up to 3 ms, one of them by 25 ms: the speed is even before,
/// and the distance to the newest pose is as before soon after.
TEST(SceneMailbox, glides_evenly_though_poses_come_early_or_late)
{
    constexpr double kSpeed_m_per_ms = 1e-4;
    SceneMailbox sut(std::vector{pose_at(0.0, Duration{1})}, kLimit);
    double at_m = 0.0;
    double step_max_m = 0.0;
    double behind_max_m = 0.0;
    int arrives = 0;
    for (int ms = 0; ms < 1'000; ++ms)
    {
        const int pose = ms / 10;
        if (ms % 10 == 0)
        {
            arrives = ms + pose * 7 % 4;
        }
        const bool is_held_up = pose >= 50 && ms < 525; // Delayed poses arrive together.
        if ((ms == arrives && !is_held_up) || ms == 525)
        {
            sut.put(0, pose_at(kSpeed_m_per_ms * 10.0 * pose, milliseconds(10 * pose + 1)),
                    kStart + milliseconds(ms));
        }
        sut.note_heard(0, kStart + milliseconds(ms));
        double next_m = at_m;
        for (const SceneChange& change : sut.refresh(kStart + milliseconds(ms)))
        {
            next_m = change.pose.translation_m.x();
        }
        const bool is_settled = (ms > 100 && ms < 500) || ms > 700;
        step_max_m = is_settled ? std::max(step_max_m, next_m - at_m) : step_max_m;
        behind_max_m =
            is_settled ? std::max(behind_max_m, kSpeed_m_per_ms * ms - next_m) : behind_max_m;
        EXPECT_GE(next_m, at_m) << ms;
        at_m = next_m;
    }
    EXPECT_LE(step_max_m, 1.1 * kSpeed_m_per_ms);
    EXPECT_GE(step_max_m, kSpeed_m_per_ms);
    EXPECT_LE(behind_max_m, 18.0 * kSpeed_m_per_ms); // Interval, delay and reserve.
}

TEST(SceneMailbox, ends_a_glide_at_the_pose_and_goes_no_farther)
{
    SceneMailbox sut(std::vector{pose_at(0.0, {})}, kLimit);
    sut.put(0, pose_at(0.0, milliseconds(1)), kStart);
    static_cast<void>(sut.refresh(kStart));
    const MonotonicTime later = kStart + milliseconds(40);
    static_cast<void>(sut.refresh(later)); // The motion starts here.
    sut.put(0, pose_at(0.01, milliseconds(41)), later);
    EXPECT_NEAR(sut.refresh(later + milliseconds(1))[0].pose.translation_m.x(), 2.5e-4, 1e-15);
    EXPECT_NEAR(sut.refresh(later + milliseconds(20))[0].pose.translation_m.x(), 0.005, 1e-15);
    EXPECT_EQ(sut.refresh(later + milliseconds(40))[0].pose.translation_m.x(), 0.01);
    EXPECT_TRUE(sut.refresh(later + milliseconds(41)).empty());
    EXPECT_EQ(sut.uses()[0].moves, 3U);
}

/// Each frame has a new pose: nothing is left to blend or to delay.
TEST(SceneMailbox, keeps_up_with_poses_that_come_as_fast_as_frames)
{
    SceneMailbox sut(std::vector{pose_at(0.0, {})}, kLimit);
    for (int ms = 1; ms < 50; ++ms)
    {
        sut.put(0, pose_at(1e-4 * ms, milliseconds(ms)), kStart + milliseconds(ms));
        const auto changes = sut.refresh(kStart + milliseconds(ms));
        ASSERT_EQ(changes.size(), 1U);
        EXPECT_EQ(changes[0].pose.translation_m.x(), 1e-4 * ms);
    }
}

TEST(SceneMailbox, takes_a_far_pose_after_a_rest_at_once_and_glides_to_a_near_one)
{
    const std::vector<ObjectPose> placed{pose_at(0.0, {})};
    SceneMailbox sut(placed, kLimit);
    sut.put(0, pose_at(0.3, milliseconds(1)), kStart); // The first pose: it was placed elsewhere.
    EXPECT_EQ(sut.refresh(kStart)[0].pose.translation_m.x(), 0.3);
    const MonotonicTime later = kStart + milliseconds(51);
    sut.put(0, pose_at(0.3 + 1.01 * SceneMailbox::kJump_m, milliseconds(52)), later);
    EXPECT_GT(sut.refresh(later)[0].pose.translation_m.x(), 0.32);
    const MonotonicTime last = kStart + milliseconds(1'051);
    sut.put(0, pose_at(0.3, milliseconds(1'052)), last);
    EXPECT_EQ(sut.refresh(last)[0].pose.translation_m.x(), 0.3);
    const MonotonicTime near = kStart + milliseconds(2'051);
    static_cast<void>(sut.refresh(near));
    sut.put(0, pose_at(0.31, milliseconds(2'052)), near);
    EXPECT_NEAR(sut.refresh(near + milliseconds(1))[0].pose.translation_m.x(), 0.3002, 1e-12);
    const MonotonicTime end = near + SceneMailbox::kBlendMax;
    EXPECT_LT(sut.refresh(end - milliseconds(1))[0].pose.translation_m.x(), 0.31);
    EXPECT_EQ(sut.refresh(end)[0].pose.translation_m.x(), 0.31);
}

TEST(SceneMailbox, keeps_the_newest_of_a_flood_and_counts_frames_that_moved)
{
    SceneMailbox sut(std::vector{pose_of(1.0)}, kLimit);
    for (int i = 2; i <= 1'000; ++i)
    {
        sut.put(0, pose_of(i), kStart);
    }
    const auto changes = sut.refresh(kStart);
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes[0].pose.scale, 1'000.0);
    EXPECT_TRUE(sut.refresh(kStart).empty());
    EXPECT_EQ(sut.uses()[0].moves, 1U);
    EXPECT_DOUBLE_EQ(sut.uses()[0].step_max_m, (Vec3(999.0, 999.0, 999.0)).norm());
}

TEST(SceneMailbox, gives_a_frame_what_it_takes_and_the_next_one_the_others_first)
{
    constexpr std::size_t kObjects = 2 * kMaxSceneChanges + 10;
    const std::vector<ObjectPose> placed(kObjects, pose_of(1.0));
    SceneMailbox sut(placed, kLimit);
    const auto move_all = [&sut](double number)
    {
        for (std::size_t i = 0; i < kObjects; ++i)
        {
            sut.put(i, pose_of(number + static_cast<double>(i)), kStart);
        }
    };
    move_all(10.0);
    std::size_t next = 0;
    for (const std::size_t most : {std::size_t{kMaxSceneChanges}, std::size_t{kMaxSceneChanges}})
    {
        const auto changes = sut.refresh(kStart);
        ASSERT_EQ(changes.size(), most);
        for (const SceneChange& change : changes)
        {
            ASSERT_EQ(change.number, next++);
            ASSERT_EQ(change.pose.scale, 10.0 + change.number);
        }
    }
    move_all(20.0); // Waiting ones are first, with their present poses.
    const auto changes = sut.refresh(kStart);
    ASSERT_EQ(changes.size(), kMaxSceneChanges);
    EXPECT_EQ(changes[0].number, next);
    EXPECT_EQ(changes[0].pose.scale, 20.0 + static_cast<double>(next));
}

/// 300 objects at 0.3 m/s, of which a frame takes 64; tools move from object to object.
TEST(SceneMailbox, moves_what_is_touched_in_every_frame_however_many_move)
{
    constexpr std::size_t kObjects = 300;
    constexpr double kSpeed_m_per_s = 0.3;
    std::vector<ObjectPose> placed(kObjects);
    SceneMailbox sut(placed, kObjects, kLimit, 0.5);
    std::vector<int> moves(kObjects);
    std::vector<Vec3> places_m(kObjects, Vec3::Zero());
    for (int ms = 0; ms < 2'000; ++ms)
    {
        const MonotonicTime now = kStart + milliseconds(ms);
        if (ms % 10 == 0)
        {
            ObjectPose pose;
            pose.translation_m = Vec3(1e-3 * kSpeed_m_per_s * ms, 0.0, 0.0);
            pose.stamp_ns = now.ns;
            for (std::size_t i = 0; i < kObjects; ++i)
            {
                sut.put(i, pose, now);
            }
        }
        const auto first = static_cast<std::uint32_t>(ms / 100 * 7 % 200);
        std::vector<ObjectTouch> touches; // Two of the first ones: a tool each.
        for (const std::uint32_t object : {first, first, first + 1, first + 90})
        {
            touches.push_back({.object = object, .place_m = places_m[object], .radius_m = 0.01});
        }
        std::vector<int> told(kObjects);
        for (const SceneChange& change : sut.refresh(now, touches))
        {
            ++told[change.number];
            ++moves[change.number];
            const double step_m = (change.pose.translation_m - places_m[change.number]).norm();
            const bool is_long_touched = ms % 100 > 1 && ms > 100;
            const bool is_touched =
                std::ranges::find(touches, change.number, &ObjectTouch::object) != touches.end();
            // One frame's motion, not that since its last turn.
            ASSERT_LE(step_m, is_long_touched && is_touched ? 4e-4 : 2.2e-3) << change.number;
            places_m[change.number] = change.pose.translation_m;
        }
        for (const ObjectTouch& touch : touches)
        {
            ASSERT_FALSE(sut.exceeds_limit(touch.object)) << ms;
        }
        ASSERT_LE(std::ranges::max(told), 1) << ms;
    }
    for (std::size_t i = 0; i < kObjects; ++i)
    {
        EXPECT_EQ(sut.uses()[i].rate_limited_frames, 0U) << i;
        EXPECT_GT(moves[i], 300) << "each has its turn: " << i;
    }
}

/// Greatest motion in a frame that a tool of 7 mm at `tool_m` could meet, while an object moves to
/// a pose of 50 ms later; it had no rotation before.
double farthest_way_m(const ObjectPose& to, const Vec3& tool_m, Duration rest, bool& rate_limited)
{
    constexpr double kReach_m = 0.007;
    ObjectPose from;
    from.stamp_ns = 1;
    SceneMailbox sut({&from, 1}, 1, kLimit, 0.5);
    sut.put(0, from, kStart);
    static_cast<void>(sut.refresh(kStart));
    ObjectPose news = to;
    news.stamp_ns = 1 + rest.ns;
    const ObjectTouch touch{.place_m = tool_m, .radius_m = kReach_m};
    static_cast<void>(sut.refresh(kStart + rest - milliseconds(1), {&touch, 1}));
    sut.put(0, news, kStart + rest);
    Similarity last = from;
    double most_m = 0.0;
    rate_limited = false;
    for (int ms = 0; ms < 500; ++ms)
    {
        for (const SceneChange& change : sut.refresh(kStart + rest + milliseconds(ms), {&touch, 1}))
        {
            for (int corner = 0; corner < 6; ++corner)
            {
                Vec3 point_m = tool_m;
                point_m[corner % 3] += corner < 3 ? kReach_m : -kReach_m;
                const Vec3 now_m = change.pose.local_to_world(last.world_to_local(point_m));
                most_m = std::max(most_m, (now_m - point_m).norm());
            }
            last = change.pose;
        }
        rate_limited = rate_limited || sut.exceeds_limit(0);
    }
    EXPECT_NEAR((last.local_to_world(Vec3::UnitX()) - to.local_to_world(Vec3::UnitX())).norm(), 0.0,
                1e-12);
    return most_m;
}

/// Motion by translation, rotation about itself or the tool, and scale; after a rest and without
/// one.
TEST(SceneMailbox, moves_nothing_that_a_tool_may_meet_faster_than_is_believed)
{
    const Vec3 tool_m(0.3, 0.2, 0.1);
    const auto about = [&](const Vec3& center_m, double angle, double scale)
    {
        ObjectPose pose;
        pose.rotation = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
        pose.scale = scale;
        pose.translation_m = center_m - scale * (pose.rotation * center_m);
        return pose;
    };
    ObjectPose away;
    away.translation_m = Vec3(0.009, 0.0, 0.0);
    for (const ObjectPose& to :
         {away, about(Vec3::Zero(), 0.02, 1.0), about(tool_m, 0.2, 1.0), about(tool_m, 0.0, 1.9),
          about(tool_m, 1.0, 1.0), about(tool_m + Vec3(0.001, 0.0, 0.0), 1.2, 0.7)})
    {
        bool rate_limited = false;
        EXPECT_LE(farthest_way_m(to, tool_m, milliseconds(2), rate_limited), 5.2e-4)
            << to.translation_m.transpose();
        const double after_rest_m = farthest_way_m(to, tool_m, milliseconds(80), rate_limited);
        EXPECT_TRUE(rate_limited || after_rest_m <= 5.2e-4) << to.translation_m.transpose();
    }
}

TEST(SceneMailbox, takes_what_outruns_its_belief_after_a_rest_at_once_and_says_so)
{
    ObjectPose to;
    to.translation_m = Vec3(0.03, 0.0, 0.0);
    bool rate_limited = false;
    EXPECT_NEAR(farthest_way_m(to, Vec3::Zero(), milliseconds(80), rate_limited), 0.03, 1e-12);
    EXPECT_TRUE(rate_limited);
    EXPECT_LE(farthest_way_m(to, Vec3::Zero(), milliseconds(2), rate_limited), 5.2e-4);
    EXPECT_TRUE(rate_limited);
}

/// Times of a server may be any numbers: no difference of them overflows.
TEST(SceneMailbox, takes_poses_of_any_time_that_the_clock_of_their_server_shows)
{
    constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    SceneMailbox sut(std::vector{pose_at(0.0, {})}, kLimit);
    int ms = 0;
    for (const std::int64_t first : {kLeast, kLeast + 1, std::int64_t{-1}, std::int64_t{0}, kMost})
    {
        for (const std::int64_t second : {kMost, kMost - 1, std::int64_t{1}, kLeast})
        {
            for (const std::int64_t stamp : {first, second})
            {
                sut.put(0, pose_at(1e-5 * ms, Duration{stamp}), kStart + milliseconds(ms));
                static_cast<void>(sut.refresh(kStart + milliseconds(ms)));
                ++ms;
            }
        }
    }
    const auto last = sut.refresh(kStart + milliseconds(ms) + SceneMailbox::kBlendMax);
    ASSERT_EQ(last.size(), 1U);
    EXPECT_EQ(last[0].pose.translation_m.x(), 1e-5 * (ms - 1));
    EXPECT_LT(sut.uses()[0].step_max_m, 1e-3);
}

/// More objects than a frame checks for their age.
TEST(SceneMailbox, tells_of_each_of_many_silent_objects_before_the_limit_once)
{
    constexpr std::size_t kObjects = 1'000;
    static_assert(kObjects > 2 * SceneMailbox::kAgedAFrame);
    const std::vector<ObjectPose> placed(kObjects, pose_of(1.0));
    SceneMailbox sut(placed, kLimit);
    for (std::size_t i = 0; i < kObjects; i += 2) // The others belong to no server.
    {
        sut.put(i, pose_of(2.0 + static_cast<double>(i)), kStart);
    }
    std::vector<int> moved(kObjects);
    std::vector<int> told(kObjects);
    for (int ms = 0; ms <= 100; ++ms)
    {
        for (const SceneChange& change : sut.refresh(kStart + milliseconds(ms)))
        {
            const bool is_old = change.pose.arrival_ns != 0;
            ++(is_old ? told : moved)[change.number];
            EXPECT_TRUE(!is_old || ms > 50) << change.number;
        }
    }
    for (std::size_t i = 0; i < kObjects; ++i)
    {
        ASSERT_EQ(moved[i] > 0, i % 2 == 0) << i;
        ASSERT_EQ(told[i], i % 2 == 0 ? 1 : 0) << i;
    }
    // Each counts the number of frames, within a round.
    for (int ms = 101; ms <= 140; ++ms)
    {
        EXPECT_TRUE(sut.refresh(kStart + milliseconds(ms)).empty());
    }
    for (std::size_t i = 0; i < kObjects; ++i)
    {
        const std::uint64_t frames = sut.uses()[i].old_frames;
        ASSERT_TRUE(i % 2 == 0 ? frames >= 36 && frames <= 44 : frames == 0) << i << ' ' << frames;
        ASSERT_GE(sut.uses()[i].age_max.ns, i % 2 == 0 ? milliseconds(136).ns : 0);
    }
}

TEST(SceneMailbox, leaves_an_object_that_came_and_whose_server_falls_silent_where_it_stands)
{
    SceneMailbox sut({}, 3, kLimit);
    ASSERT_TRUE(sut.try_add(2, 1, {}, pose_of(4.0), kStart));
    ASSERT_EQ(sut.refresh(kStart).size(), 1U);
    const auto silent = sut.refresh(kStart + milliseconds(60));
    ASSERT_EQ(silent.size(), 1U);
    EXPECT_EQ(silent[0].kind, SceneChangeKind::object_moves);
    EXPECT_EQ(silent[0].generation, 1U);
    EXPECT_EQ(silent[0].pose.translation_m, pose_of(4.0).translation_m);
    EXPECT_EQ(silent[0].pose.scale, 4.0);
    EXPECT_EQ(silent[0].pose.arrival_ns, kStart.ns);
    EXPECT_EQ(sut.uses()[2].moves, 0U);
}

/// Any poses in any order: each object ends at its last pose.
TEST(SceneMailbox, forgets_no_object_of_many_that_move_at_random)
{
    constexpr std::size_t kObjects = 4'096;
    constexpr std::uint64_t kSeed = 20'261'124;
    std::mt19937_64 random(kSeed);
    const std::vector<ObjectPose> placed(kObjects, pose_at(0.0, Duration{1}));
    SceneMailbox sut(placed, kLimit);
    std::vector<double> last_m(kObjects);
    std::vector<double> seen_m(kObjects);
    const auto refresh = [&](int ms)
    {
        for (const SceneChange& change : sut.refresh(kStart + milliseconds(ms)))
        {
            seen_m[change.number] = change.pose.translation_m.x();
        }
    };
    int ms = 0;
    for (; ms < 300; ++ms)
    {
        const MonotonicTime now = kStart + milliseconds(ms);
        for (std::uint64_t i = random() % 40; i > 0; --i)
        {
            const std::size_t object = random() % kObjects;
            last_m[object] += 1e-4;
            sut.put(object, pose_at(last_m[object], milliseconds(ms + 1)), now);
        }
        refresh(ms);
    }
    for (std::size_t i = 0; i < kObjects; ++i)
    {
        sut.note_heard(i, kStart + milliseconds(ms + 400));
    }
    for (const int end = ms + 400; ms < end; ++ms)
    {
        refresh(ms);
    }
    EXPECT_EQ(seen_m, last_m) << "seed " << kSeed;
}

TEST(SceneMailbox, brings_an_object_with_what_it_is_and_takes_it_away)
{
    const std::vector<ObjectPose> placed{pose_of(1.0)};
    SceneMailbox sut(placed, 3, kLimit);
    const ObjectSpec spec{ModelId{7}, {300.0, 0.4, 0.2, 1.5}};
    ASSERT_TRUE(sut.try_add(2, 1, spec, pose_of(4.0), kStart));
    sut.put(2, pose_of(5.0), kStart); // Before the frame knows that it exists.
    const auto came = sut.refresh(kStart);
    ASSERT_EQ(came.size(), 2U);
    EXPECT_EQ(came[0].kind, SceneChangeKind::object_comes);
    EXPECT_EQ(came[0].number, 2U);
    EXPECT_EQ(came[0].generation, 1U);
    EXPECT_EQ(came[0].object.model.value, 7U);
    EXPECT_EQ(came[0].object.material.stiffness_n_per_m, 300.0);
    EXPECT_EQ(came[0].object.material.static_friction, 0.4);
    EXPECT_EQ(came[0].object.material.dynamic_friction, 0.2);
    EXPECT_EQ(came[0].object.material.damping_n_s_per_m, 1.5);
    EXPECT_TRUE(is_whole(came[0].pose));
    EXPECT_EQ(came[0].pose.scale, 4.0);
    EXPECT_EQ(came[1].kind, SceneChangeKind::object_moves);
    EXPECT_EQ(came[1].generation, 1U);
    EXPECT_TRUE(sut.uses()[2].is_followed);

    ASSERT_TRUE(sut.try_remove(2));
    sut.put(2, pose_of(6.0), kStart);
    const auto went = sut.refresh(kStart + milliseconds(1));
    ASSERT_EQ(went.size(), 1U); // The pending pose is dropped.
    EXPECT_EQ(went[0].kind, SceneChangeKind::object_goes);
    EXPECT_EQ(went[0].number, 2U);
    EXPECT_EQ(went[0].generation, 1U);
    EXPECT_TRUE(sut.refresh(kStart + milliseconds(1000)).empty()); // The place does not age either.
}

TEST(SceneMailbox, tells_that_an_object_feels_otherwise_in_its_turn)
{
    const std::vector<ObjectPose> placed{pose_of(1.0)};
    SceneMailbox sut(placed, 2, kLimit);
    const Material honey{300.0, 0.4, 0.2, 1.5, 2.5, 1e-5, 1e-3};
    ASSERT_TRUE(sut.try_set_material(0, honey));
    ASSERT_TRUE(sut.try_add(1, 5, {}, pose_of(2.0), kStart));
    ASSERT_TRUE(sut.try_set_material(1, honey));
    ASSERT_TRUE(sut.try_remove(1));
    const auto changes = sut.refresh(kStart);
    ASSERT_EQ(changes.size(), 4U);
    EXPECT_EQ(changes[0].kind, SceneChangeKind::object_feels);
    EXPECT_EQ(changes[0].number, 0U);
    EXPECT_EQ(changes[0].generation, 0U);
    EXPECT_EQ(changes[0].object.material, honey);
    EXPECT_EQ(changes[1].kind, SceneChangeKind::object_comes);
    EXPECT_EQ(changes[2].kind, SceneChangeKind::object_feels);
    EXPECT_EQ(changes[2].generation, 5U);
    EXPECT_EQ(changes[3].kind, SceneChangeKind::object_goes);
    EXPECT_FALSE(sut.uses()[0].is_followed) << "what it feels like says nothing of where it is";
    std::size_t waiting = 0;
    while (sut.try_set_material(0, honey))
    {
        ++waiting;
    }
    EXPECT_EQ(waiting, SceneMailbox::kWaiting);
    sut.put(0, pose_of(2.0), kStart);
    const auto capacity_exceeded = sut.refresh(kStart);
    ASSERT_EQ(capacity_exceeded.size(), SceneMailbox::kTakenAFrame + 1)
        << "a move has room beside them";
    EXPECT_EQ(capacity_exceeded.back().kind, SceneChangeKind::object_moves);
    EXPECT_TRUE(sut.try_set_material(0, honey));
}

TEST(SceneMailbox, gives_no_object_what_was_put_for_the_one_before)
{
    SceneMailbox sut({}, 1, kLimit);
    ASSERT_TRUE(sut.try_add(0, 1, {}, pose_of(1.0), kStart));
    ASSERT_EQ(sut.refresh(kStart).size(), 1U);
    sut.put(0, pose_of(2.0), kStart);
    ASSERT_TRUE(sut.try_remove(0));
    ASSERT_TRUE(sut.try_add(0, 2, {}, pose_of(3.0), kStart));
    const auto changes = sut.refresh(kStart + milliseconds(1));
    ASSERT_EQ(changes.size(), 2U);
    EXPECT_EQ(changes[0].kind, SceneChangeKind::object_goes);
    EXPECT_EQ(changes[0].generation, 1U);
    EXPECT_EQ(changes[1].kind, SceneChangeKind::object_comes);
    EXPECT_EQ(changes[1].generation, 2U);
    EXPECT_EQ(changes[1].pose.scale, 3.0);
}

TEST(SceneMailbox, takes_no_more_comings_than_may_wait_and_gives_a_frame_what_it_takes)
{
    SceneMailbox sut({}, SceneMailbox::kWaiting + 1, kLimit);
    for (std::size_t i = 0; i < SceneMailbox::kWaiting; ++i)
    {
        ASSERT_TRUE(sut.try_add(i, 1, {}, pose_of(1.0), kStart));
    }
    EXPECT_FALSE(sut.try_add(SceneMailbox::kWaiting, 1, {}, pose_of(1.0), kStart));
    EXPECT_FALSE(sut.try_remove(0));
    for (std::size_t first = 0; first < SceneMailbox::kWaiting; first += SceneMailbox::kTakenAFrame)
    {
        const auto changes = sut.refresh(kStart);
        ASSERT_EQ(changes.size(), SceneMailbox::kTakenAFrame);
        EXPECT_EQ(changes[0].number, first);
    }
    EXPECT_TRUE(sut.refresh(kStart).empty());
    EXPECT_TRUE(sut.try_add(SceneMailbox::kWaiting, 1, {}, pose_of(1.0), kStart));
}

} // namespace
} // namespace tactus
