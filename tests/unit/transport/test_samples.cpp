// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/model_pieces.hpp"
#include "transport/dds/piece_exchange.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/request_queue.hpp"
#include "transport/dds/telemetry.hpp"
#include "transport/telemetry_from_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tactus.h"

/// Checks of single samples of telemetry, without a network.
namespace tactus::dds
{
namespace
{

std::vector<std::byte> two_pieces()
{
    std::vector<std::byte> payload;
    const std::string first = "first piece";
    const std::string second = "2nd";
    append_piece(payload, {{1, 2, 3}, 7, 2, 40}, std::as_bytes(std::span(first)));
    append_piece(payload, {{1, 2, 3}, 7, 1, 41}, std::as_bytes(std::span(second)));
    return payload;
}

TEST(PieceFrame, reads_back_what_was_appended)
{
    const auto payload = two_pieces();
    EXPECT_EQ(payload.size(), 2 * 32 + 11 + 3U);
    PieceReader sut(payload);
    const auto first = sut.next();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->key, (WireKey{{1, 2, 3}, 7, 2, 40}));
    EXPECT_EQ(first->bytes.size(), 11U);
    const auto second = sut.next();
    ASSERT_TRUE(second);
    EXPECT_EQ(second->key.number, 41U);
    EXPECT_EQ(static_cast<char>(second->bytes[2]), 'd');
    EXPECT_FALSE(sut.next());
    EXPECT_FALSE(sut.is_broken());
}

TEST(PieceFrame, a_length_beyond_the_payload_is_broken_behind_the_pieces_before)
{
    auto payload = two_pieces();
    std::fill_n(payload.begin() + 43 + 28, 4, std::byte{0xFF});
    PieceReader sut(payload);
    EXPECT_TRUE(sut.next());
    EXPECT_FALSE(sut.next());
    EXPECT_TRUE(sut.is_broken());
}

TEST(CreditWindow, grants_a_window_beyond_what_was_seen_and_survives_loss)
{
    CreditWindow sut(10);
    EXPECT_EQ(sut.granted(), 10U);
    sut.on_sample(4, 4);
    EXPECT_EQ(sut.granted(), 14U);
    sut.on_sample(9, 2); // Three pieces before it were lost, as the count shows.
    EXPECT_EQ(sut.granted(), 19U);
    EXPECT_EQ(sut.received(), 6U);
    sut.on_sample(7, 3); // Late and out of order: nothing is reduced.
    EXPECT_EQ(sut.granted(), 19U);
    sut.write_off();
    EXPECT_EQ(sut.granted(), 29U);
}

TEST(RequestQueue, puts_the_newest_generation_first_and_keeps_its_order)
{
    RequestQueue sut(8);
    const auto add = [&](std::uint32_t number, std::uint32_t generation) {
        sut.add({number % 2, {ContentKind::chunk, number}}, generation);
    };
    add(1, 5);
    add(2, 5);
    add(3, 6);
    add(4, 6);
    add(5, 4);
    add(1, 6); // Requested again, newer.
    std::vector<std::uint32_t> order;
    for (; !sut.empty(); sut.pop_front())
    {
        order.push_back(sut.front().key.number);
    }
    EXPECT_EQ(order, (std::vector<std::uint32_t>{3, 4, 1, 2, 5}));
}

TEST(RequestQueue, tells_the_same_piece_of_two_models_apart)
{
    RequestQueue sut(8);
    sut.add({0, {ContentKind::chunk, 1}}, 5);
    sut.add({1, {ContentKind::chunk, 1}}, 5);
    sut.add({1, {ContentKind::chunk, 1}}, 5);
    EXPECT_EQ(sut.size(), 2U);
}

TEST(ModelParts, are_of_one_size_but_the_last_and_make_the_whole)
{
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, kPartBytes - 1, kPartBytes,
                                    kPartBytes + 1, 3 * kPartBytes})
    {
        const std::vector<std::byte> whole(bytes);
        std::size_t sum = 0;
        for (std::uint32_t part = 0; part < parts_of(bytes); ++part)
        {
            EXPECT_EQ(part_of(whole, part).data(), whole.data() + sum);
            sum += part_of(whole, part).size();
        }
        EXPECT_EQ(sum, bytes);
        EXPECT_TRUE(part_of(whole, parts_of(bytes)).empty());
    }
}

TEST(RequestQueue, forgets_the_oldest_generation_when_full_and_generations_may_wrap)
{
    RequestQueue sut(2);
    sut.add({0, {ContentKind::chunk, 1}}, 0xFFFF'FFFFU);
    sut.add({0, {ContentKind::chunk, 2}}, 0);
    sut.add({0, {ContentKind::chunk, 3}}, 1);
    EXPECT_EQ(sut.size(), 2U);
    EXPECT_EQ(sut.forgotten(), 1U);
    EXPECT_EQ(sut.front().key.number, 3U);
    sut.pop_front();
    EXPECT_EQ(sut.front().key.number, 2U);
}

/// Random requests in a random order, compared with a sorted list.
TEST(RequestQueue, is_in_the_order_of_a_list_that_is_searched)
{
    constexpr std::size_t kCapacity = 40;
    struct Request
    {
        std::uint32_t number;
        std::uint32_t generation;
    };
    std::mt19937 random(20260731);
    RequestQueue sut(kCapacity);
    std::vector<Request> list;
    std::uint64_t forgotten = 0;
    for (int i = 0; i < 20'000; ++i)
    {
        if (!list.empty() && random() % 4 == 0)
        {
            ASSERT_EQ(sut.front().key.number, list.front().number) << i;
            sut.pop_front();
            list.erase(list.begin());
            continue;
        }
        const Request request{static_cast<std::uint32_t>(random() % 60),
                              static_cast<std::uint32_t>(i / 50) +
                                  static_cast<std::uint32_t>(random() % 4) - 10};
        sut.add({0, {ContentKind::chunk, request.number}}, request.generation);
        std::erase_if(list, [&](const Request& known) { return known.number == request.number; });
        list.insert(std::ranges::find_if(list,
                                         [&](const Request& known) {
                                             return static_cast<std::int32_t>(
                                                        known.generation - request.generation) < 0;
                                         }),
                    request);
        if (list.size() > kCapacity)
        {
            list.pop_back();
            ++forgotten;
        }
        ASSERT_EQ(sut.size(), list.size()) << i;
    }
    EXPECT_GT(forgotten, 0U);
    EXPECT_EQ(sut.forgotten(), forgotten);
    for (const Request& request : list)
    {
        EXPECT_EQ(sut.front().key.number, request.number);
        sut.pop_front();
    }
    EXPECT_TRUE(sut.empty());
}

constexpr double kFar_m = 2.0 * kPoseReachMax_m;
constexpr const char* kWord = "W\u00FCrfel-\u7ACB\u65B9";
/// Texts that no terminal should get: a control, half a character, a change of direction.
constexpr const char* kUnclear[] = {"a\x1b[31m", "a\xc3", "a\u202E"};

tactus_v5_Placement placement(double x_m, double scale)
{
    return {{0.0, 0.0, 0.0, 1.0}, {x_m, 0.0, 0.0}, scale};
}

/// Telemetry of one object.
bool is_accepted(tactus_v5_ObjectTelemetry object)
{
    tactus_v5_Telemetry sample = {};
    std::strcpy(static_cast<char*>(sample.controller_name), "desk");
    sample.objects = {1, 1, &object, false};
    const auto news = watched_from(sample);
    EXPECT_TRUE(!news || news->objects.objects.at(0).name == static_cast<char*>(object.name));
    return news.has_value();
}

/// Telemetry with the refinement state of one tool.
bool is_accepted(tactus_v5_RefinementStateTool tool)
{
    tactus_v5_RefinementState state = {};
    state.tools = {1, 1, &tool, false};
    tactus_v5_Telemetry sample = {};
    std::strcpy(static_cast<char*>(sample.controller_name), "desk");
    sample.refinement_state = {1, 1, &state, false};
    const auto news = watched_from(sample);
    EXPECT_TRUE(!news || news->state->state.tools.at(0).shape == static_cast<char*>(tool.shape));
    return news.has_value();
}

TEST(ReportSamples, have_the_letters_of_every_language_but_no_controls)
{
    tactus_v5_ObjectTelemetry object = {};
    object.pose = placement(0.0, 1.0);
    tactus_v5_RefinementStateTool tool = {};
    std::strcpy(static_cast<char*>(object.name), kWord);
    std::strcpy(static_cast<char*>(tool.shape), (std::string("mesh:") + kWord).c_str());
    EXPECT_TRUE(is_accepted(object));
    EXPECT_TRUE(is_accepted(tool));
    for (const char* unclear : kUnclear)
    {
        std::strcpy(static_cast<char*>(object.name), unclear);
        std::strcpy(static_cast<char*>(tool.shape), unclear);
        EXPECT_FALSE(is_accepted(object)) << unclear;
        EXPECT_FALSE(is_accepted(tool)) << unclear;
    }
}

TEST(ReportSamples, may_place_an_object_far_away_but_with_a_possible_scale)
{
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const double x_m : {0.0, kFar_m, -kFar_m})
    {
        for (const double scale : {1.0, 0.0, -1.0, 0.5 * kPoseScaleMin, 2.0 * kPoseScaleMax, kNan})
        {
            tactus_v5_ObjectTelemetry object = {};
            object.pose = placement(x_m, scale);
            EXPECT_EQ(is_accepted(object), scale == 1.0) << x_m << ' ' << scale;
        }
    }
}

TEST(ReportSamples, have_poses_of_the_source_mesh_that_lead_back_to_the_models_frame)
{
    Similarity frame;
    frame.rotation = Eigen::Quaterniond(0.8, 0.0, 0.6, 0.0).toRotationMatrix();
    frame.translation_m = {1.0, -2.0, 3.0};
    frame.scale = 2.0;
    const Vec3 origin_m{0.1, 0.2, 0.3};
    const Pose source = source_pose_of(frame, origin_m);
    for (int axis = 0; axis < 3; ++axis) // The source's point `origin_m` is the frame's origin.
    {
        const Vec3 rotated_m = frame.rotation * origin_m;
        EXPECT_NEAR(source.translation_m[static_cast<std::size_t>(axis)],
                    frame.translation_m[axis] - 2.0 * rotated_m[axis], 1e-15);
    }
    const Pose back = frame_pose_of(source, origin_m);
    for (int axis = 0; axis < 3; ++axis)
    {
        EXPECT_NEAR(back.translation_m[static_cast<std::size_t>(axis)], frame.translation_m[axis],
                    1e-15);
    }
    EXPECT_EQ(back.rotation, source.rotation);
    EXPECT_EQ(back.scale, 2.0);
}

} // namespace
} // namespace tactus::dds
