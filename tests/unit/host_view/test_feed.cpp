// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Both forms of the feed against the struct for programs that read it (docs/examples).

#include "host_tools/spm_view/feed.hpp"
#include "rt_core/math/infinity.hpp"
#include "tests/unit/host_view/live_rig.hpp"
#include "transport/content_hash.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <tactus_feed.h>
#include <vector>

namespace tactus::view
{
namespace
{

/// A controller with two tools, whose values all differ, and this many objects.
LiveController controller_with(std::size_t objects)
{
    LiveController live;
    live.told = test::told(7, "hall-2");
    live.told.serial = 41;
    Telemetry& telemetry = live.told.telemetry;
    telemetry.frame = 1'234;
    telemetry.time_ns = 987'654'321'000;
    telemetry.period_ns = 1'000'000;
    telemetry.tool_count = 2;
    double next = 1.0 / 3.0;
    for (ToolTelemetry& tool : {std::ref(telemetry.tools[0]), std::ref(telemetry.tools[1])})
    {
        for (double* number :
             {&tool.position_m[0],     &tool.position_m[1],     &tool.position_m[2],
              &tool.rotation[0],       &tool.rotation[1],       &tool.rotation[2],
              &tool.rotation[3],       &tool.proxy_m[0],        &tool.proxy_m[1],
              &tool.proxy_m[2],        &tool.proxy_rotation[0], &tool.proxy_rotation[1],
              &tool.proxy_rotation[2], &tool.proxy_rotation[3], &tool.force_n[0],
              &tool.force_n[1],        &tool.force_n[2],        &tool.torque_nm[0],
              &tool.torque_nm[1],      &tool.torque_nm[2],      &tool.gripper_m})
        {
            *number = next += 0.7;
        }
    }
    telemetry.tools[0].in_contact = telemetry.tools[0].data_limited = true;
    telemetry.tools[1].has_gripper = telemetry.tools[1].halted = true;
    telemetry.tools[1].buttons = 5;
    // The state has the first tool only.
    live.told.state = std::make_shared<const dds::SeenState>(dds::SeenState{3, test::state()});
    for (std::uint32_t i = 0; i < objects; ++i)
    {
        ObjectTelemetry& object = live.objects.emplace_back();
        object.number = i;
        object.object = 1'000 + i;
        object.server_epoch = 0xFEDC'BA98'7654'3210U;
        object.name = std::string(i % 64, 'n');
        object.model.fill(static_cast<std::uint8_t>(i));
        object.pose = {{0.0, 0.6, 0.0, 0.8}, {0.25 * i, -1.0, 2.0}, 1.0 + i};
    }
    return live;
}

std::unique_ptr<tactus_feed> read_of(const std::string& datagram)
{
    auto feed = std::make_unique<tactus_feed>();
    const char* refused = tactus_feed_read(feed.get(), datagram.data(), datagram.size());
    EXPECT_EQ(refused, nullptr) << refused;
    return feed;
}

template <typename Array>
std::vector<double> list_of(const Array& numbers)
{
    return {std::begin(numbers), std::end(numbers)};
}

TEST(Feed, has_the_same_values_as_json_and_as_struct)
{
    const LiveController live = controller_with(3);
    const auto json = nlohmann::json::parse(feed_json(live));
    const auto datagrams = feed_datagrams(live);
    ASSERT_EQ(datagrams.size(), 1U);
    const auto read = read_of(datagrams[0]);
    EXPECT_EQ(read->head.version, json["version"].get<int>());
    EXPECT_EQ(read->head.period_ns, 1'000'000U);
    EXPECT_EQ(json["period_ns"], 1'000'000);
    EXPECT_EQ(read->head.serial, 41U);
    EXPECT_EQ(json["serial"], 41);
    EXPECT_EQ(read->head.frame, 1'234U);
    EXPECT_EQ(json["frame"], 1'234);
    EXPECT_EQ(read->head.time_ns, 987'654'321'000);
    EXPECT_EQ(json["time_ns"], 987'654'321'000);
    EXPECT_STREQ(static_cast<const char*>(read->head.name), "hall-2");
    EXPECT_EQ(json["name"], "hall-2");
    EXPECT_EQ(json["controller"], std::string("07070707070707070707070707070707"));
    ASSERT_EQ(read->head.tool_count, 2U);
    ASSERT_EQ(json["tools"].size(), 2U);
    for (std::size_t i = 0; i < 2; ++i)
    {
        const ToolTelemetry& tool = live.told.telemetry.tools[i];
        const tactus_feed_tool& packed = read->tools[i];
        const auto& text = json["tools"][i];
        const auto expect = [&text](const char* name, const auto& wanted, const auto& got)
        {
            EXPECT_EQ(list_of(wanted), list_of(got)) << name;
            EXPECT_EQ(text[name].get<std::vector<double>>(), list_of(wanted)) << name;
        };
        expect("position_m", tool.position_m, packed.position_m);
        expect("rotation", tool.rotation, packed.rotation);
        expect("proxy_m", tool.proxy_m, packed.proxy_m);
        expect("proxy_rotation", tool.proxy_rotation, packed.proxy_rotation);
        expect("force_n", tool.force_n, packed.force_n);
        expect("torque_nm", tool.torque_nm, packed.torque_nm);
        EXPECT_EQ(packed.gripper_m, tool.gripper_m);
        EXPECT_EQ(text["gripper_m"], tool.gripper_m);
        EXPECT_EQ(text["in_contact"], i == 0);
        EXPECT_EQ(text["halted"], i == 1);
        EXPECT_EQ(packed.buttons, i == 0 ? 0U : 5U);
    }
    EXPECT_EQ(read->tools[0].flags,
              std::uint32_t{TACTUS_FEED_IN_CONTACT | TACTUS_FEED_DATA_LIMITED});
    EXPECT_EQ(read->tools[1].flags, std::uint32_t{TACTUS_FEED_HALTED | TACTUS_FEED_HAS_GRIPPER});
    EXPECT_STREQ(static_cast<const char*>(read->tools[0].shape), "sphere:0.002");
    EXPECT_EQ(read->tools[0].radius_m, 0.002);
    EXPECT_EQ(read->tools[0].state, 2U);
    EXPECT_STREQ(static_cast<const char*>(read->tools[1].shape), "");
    EXPECT_EQ(json["tools"][1]["radius_m"], 0.0);
    ASSERT_EQ(read->head.object_count, 3U);
    const tactus_feed_object& object = read->objects[2];
    EXPECT_EQ(object.number, 2U);
    EXPECT_EQ(object.object, 1'002U);
    EXPECT_EQ(object.server, 0xFEDC'BA98'7654'3210U);
    EXPECT_EQ(list_of(object.translation_m), (std::vector{0.5, -1.0, 2.0}));
    EXPECT_EQ(list_of(object.rotation), (std::vector{0.0, 0.6, 0.0, 0.8}));
    EXPECT_EQ(object.scale, 3.0);
    EXPECT_EQ(object.model[15], 2U);
    EXPECT_STREQ(static_cast<const char*>(object.name), "nn");
    EXPECT_EQ(json["objects"][2]["server"], "fedcba9876543210");
    EXPECT_EQ(json["objects"][2]["translation_m"], (std::vector{0.5, -1.0, 2.0}));
    EXPECT_EQ(json["objects"][2]["name"], "nn");
}

TEST(Feed, divides_many_objects_among_datagrams_that_all_have_the_tools)
{
    const LiveController live = controller_with(2 * kFeedObjects + 1);
    const auto datagrams = feed_datagrams(live);
    ASSERT_EQ(datagrams.size(), 3U);
    std::uint32_t next = 0;
    for (std::size_t part = 0; part < datagrams.size(); ++part)
    {
        const auto read = read_of(datagrams[part]);
        EXPECT_EQ(read->head.part, part);
        EXPECT_EQ(read->head.part_count, 3U);
        EXPECT_EQ(read->head.tool_count, 2U);
        for (std::size_t i = 0; i < read->head.object_count; ++i)
        {
            EXPECT_EQ(read->objects[i].number, next++);
        }
    }
    EXPECT_EQ(next, live.objects.size());
    EXPECT_EQ(nlohmann::json::parse(feed_json(live))["objects"].size(), live.objects.size());
    EXPECT_EQ(feed_datagrams(controller_with(0)).size(), 1U);
}

TEST(Feed, refuses_a_datagram_cut_at_any_length_or_with_more_at_its_end)
{
    const std::string whole = feed_datagrams(controller_with(2))[0];
    const auto feed = std::make_unique<tactus_feed>();
    for (std::size_t size = 0; size < whole.size(); ++size)
    {
        const std::vector<char> cut(whole.begin(),
                                    whole.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_NE(tactus_feed_read(feed.get(), cut.data(), cut.size()), nullptr) << size;
    }
    const std::string longer = whole + '\0';
    EXPECT_NE(tactus_feed_read(feed.get(), longer.data(), longer.size()), nullptr);
}

TEST(Feed, refuses_wrong_heads_and_numbers)
{
    const std::string whole = feed_datagrams(controller_with(2))[0];
    const auto feed = std::make_unique<tactus_feed>();
    const auto refused = [&](std::size_t at, const auto& value)
    {
        std::string wrong = whole;
        std::memcpy(wrong.data() + at, &value, sizeof(value));
        return tactus_feed_read(feed.get(), wrong.data(), wrong.size()) != nullptr;
    };
    EXPECT_FALSE(refused(0, 'T'));
    EXPECT_TRUE(refused(0, 't'));
    EXPECT_TRUE(refused(offsetof(tactus_feed_head, version), std::uint16_t{2}));
    EXPECT_TRUE(refused(offsetof(tactus_feed_head, head_bytes), std::uint16_t{127}));
    EXPECT_TRUE(refused(offsetof(tactus_feed_head, tool_bytes), std::uint16_t{0}));
    EXPECT_TRUE(refused(offsetof(tactus_feed_head, object_bytes), std::uint16_t{161}));
    EXPECT_TRUE(refused(offsetof(tactus_feed_head, tool_count), std::uint16_t{17}));
    EXPECT_TRUE(refused(offsetof(tactus_feed_head, tool_count), std::uint16_t{1}));
    EXPECT_TRUE(refused(offsetof(tactus_feed_head, object_count), std::uint16_t{0xFFFF}));
    EXPECT_TRUE(refused(offsetof(tactus_feed_head, part), std::uint16_t{1}));
    EXPECT_TRUE(refused(offsetof(tactus_feed_head, part_count), std::uint16_t{0}));
    const std::size_t tool = sizeof(tactus_feed_head) + sizeof(tactus_feed_tool);
    const std::size_t object = tool + sizeof(tactus_feed_tool);
    for (const double wrong : {kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()})
    {
        EXPECT_TRUE(refused(tool + offsetof(tactus_feed_tool, radius_m), wrong));
        EXPECT_TRUE(refused(tool + offsetof(tactus_feed_tool, position_m), wrong));
        EXPECT_TRUE(refused(object + offsetof(tactus_feed_object, scale), wrong));
    }
}

TEST(FeedSender, sends_each_state_once)
{
    auto receiver = std::move(udp::Socket::open("127.0.0.1", 0)).value();
    auto sut = std::move(FeedSender::open(receiver.endpoint())).value();
    Snapshot snapshot;
    snapshot.controllers = {controller_with(kFeedObjects + 1)};
    const auto datagrams = [&]
    {
        sut.send(snapshot); // On loopback a datagram is there when the call returns.
        std::size_t count = 0;
        std::vector<std::byte> buffer(TACTUS_FEED_BYTES_MAX + 1);
        while (receiver.receive(buffer))
        {
            ++count;
        }
        return count;
    };
    EXPECT_EQ(datagrams(), 2U);
    EXPECT_EQ(datagrams(), 0U);
    ++snapshot.controllers[0].told.serial;
    EXPECT_EQ(datagrams(), 2U);
}

} // namespace
} // namespace tactus::view
