// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/transport/dds_rig.hpp"
#include "transport/dds/front.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tactus.h"

namespace tactus::dds
{
namespace
{

using test::eventually;

/// A different value in every field.
Front some_front(std::size_t tools, std::size_t models, std::size_t pages, std::size_t objects)
{
    Front front;
    double number = 0.5;
    std::uint32_t count = 10;
    front.frame = count++;
    front.time_ns = -static_cast<std::int64_t>(count++);
    for (FrontTimes& times : front.times)
    {
        times = {number += 1.0, number += 1.0};
    }
    front.budgets = {count,     count + 1, count + 2, count + 3,
                     count + 4, count + 5, count + 6, count + 7};
    front.sweep_begin = 40;
    front.sweep_end = 56;
    front.slots_left_out = 3;
    front.regions_left_out = 4;
    for (std::size_t i = 0; i < tools; ++i)
    {
        front.tools.push_back({static_cast<SafetyState>(i % kSafetyStates),
                               static_cast<ForceOff>(1U << (i % kForceOffs)),
                               std::string(i % (kMaxShapeBytes + 1), 's'), number += 1.0});
    }
    for (std::size_t i = 0; i < models; ++i)
    {
        FrontModel& model = front.models.emplace_back();
        model.hash.fill(static_cast<std::uint8_t>(i + 1));
        const std::size_t share = i + 1 < models ? pages / models : pages - i * (pages / models);
        for (std::uint32_t page = 0; page < share; ++page)
        {
            model.pages.push_back({ChunkId{3 * page + 1}, std::uint64_t{count++} << 20U});
        }
        for (std::uint32_t wish = 0; wish < kMaxFrontWishes / models; ++wish)
        {
            model.wished.push_back(ChunkId{3 * wish + 2});
        }
    }
    for (std::uint32_t i = 0; models > 0 && i < kMaxFrontRegions; ++i)
    {
        const auto place = static_cast<float>(number += 1.0);
        front.regions.push_back({static_cast<std::uint32_t>(i % models),
                                 i % 3 != 0,
                                 {place, -place, 2.0F * place},
                                 0.25F * place});
    }
    for (std::uint32_t i = 0; i < objects; ++i)
    {
        FrontObject object;
        object.host_epoch = std::uint64_t{i} << 40U;
        object.object = 1'000 + i;
        object.number = 4'095 - i;
        object.model = static_cast<std::uint32_t>(i % models);
        object.pose = {{0.0, 0.6, 0.0, 0.8}, {number += 1.0, number += 1.0, 2e4}, 1.5};
        front.objects.push_back(object);
    }
    return front;
}

void expect_same(const Front& got, const Front& sent)
{
    EXPECT_EQ(got.frame, sent.frame);
    EXPECT_EQ(got.time_ns, sent.time_ns);
    for (std::size_t i = 0; i < kFrontTimes; ++i)
    {
        EXPECT_EQ(got.times[i].mean_ns, sent.times[i].mean_ns);
        EXPECT_EQ(got.times[i].max_ns, sent.times[i].max_ns);
    }
    EXPECT_EQ(std::memcmp(&got.budgets, &sent.budgets, sizeof(Budgets)), 0);
    EXPECT_EQ(got.sweep_begin, sent.sweep_begin);
    EXPECT_EQ(got.sweep_end, sent.sweep_end);
    EXPECT_EQ(got.slots_left_out, sent.slots_left_out);
    EXPECT_EQ(got.regions_left_out, sent.regions_left_out);
    ASSERT_EQ(got.tools.size(), sent.tools.size());
    for (std::size_t i = 0; i < sent.tools.size(); ++i)
    {
        EXPECT_EQ(got.tools[i].state, sent.tools[i].state);
        EXPECT_EQ(got.tools[i].causes, sent.tools[i].causes);
        EXPECT_EQ(got.tools[i].shape, sent.tools[i].shape);
        EXPECT_EQ(got.tools[i].radius_m, sent.tools[i].radius_m);
    }
    ASSERT_EQ(got.models.size(), sent.models.size());
    for (std::size_t i = 0; i < sent.models.size(); ++i)
    {
        EXPECT_EQ(got.models[i].hash, sent.models[i].hash);
        ASSERT_EQ(got.models[i].pages.size(), sent.models[i].pages.size());
        for (std::size_t page = 0; page < sent.models[i].pages.size(); ++page)
        {
            EXPECT_EQ(got.models[i].pages[page].chunk, sent.models[i].pages[page].chunk);
            EXPECT_EQ(got.models[i].pages[page].refined, sent.models[i].pages[page].refined);
        }
        EXPECT_EQ(got.models[i].wished, sent.models[i].wished);
    }
    EXPECT_EQ(got.regions, sent.regions);
    ASSERT_EQ(got.objects.size(), sent.objects.size());
    for (std::size_t i = 0; i < sent.objects.size(); ++i)
    {
        EXPECT_EQ(got.objects[i].host_epoch, sent.objects[i].host_epoch);
        EXPECT_EQ(got.objects[i].object, sent.objects[i].object);
        EXPECT_EQ(got.objects[i].number, sent.objects[i].number);
        EXPECT_EQ(got.objects[i].model, sent.objects[i].model);
        EXPECT_EQ(got.objects[i].pose.rotation, sent.objects[i].pose.rotation);
        EXPECT_EQ(got.objects[i].pose.translation_m, sent.objects[i].pose.translation_m);
        EXPECT_EQ(got.objects[i].pose.scale, sent.objects[i].pose.scale);
    }
}

class DdsFront : public ::testing::Test
{
protected:
    void SetUp() override
    {
        test::isolate_domains();
        viewer_.emplace(Domain::join(2).value());
        sut_ = std::move(FrontReader::create(*viewer_)).value();
    }

    std::optional<Domain> viewer_;
    std::unique_ptr<FrontReader> sut_;
};

TEST_F(DdsFront, comes_as_it_was_sent_and_goes_with_its_controller)
{
    struct Size
    {
        std::size_t tools, models, pages, objects;
    };
    for (const Size size : {Size{0, 0, 0, 0}, Size{1, 1, 1, 1},
                            Size{kMaxTools, kMaxModels, kMaxFrontPages, kMaxFrontObjects}})
    {
        const Domain controller = Domain::join(1).value();
        const auto writer = std::move(FrontWriter::create(controller, "one")).value();
        const Front sent = some_front(size.tools, size.models, size.pages, size.objects);
        ASSERT_TRUE(eventually(
            [&]
            {
                writer->write(sent);
                sut_->poll(); // The last one's end may still be on its way.
                return sut_->fronts().size() == 1 &&
                       sut_->fronts()[0].id == controller.participants().own();
            }));
        EXPECT_GT(sut_->fronts()[0].serial, 0U);
        expect_same(sut_->fronts()[0].front, sent);
    }
    EXPECT_TRUE(eventually(
        [&]
        {
            sut_->poll();
            return sut_->fronts().empty();
        }));
    EXPECT_EQ(sut_->refused(), 0U);
}

TEST_F(DdsFront, of_a_controller_that_it_does_not_come_from_is_not_heard)
{
    const Domain controller = Domain::join(1).value();
    const auto good = std::move(FrontWriter::create(controller, "good")).value();
    const Domain stranger = Domain::join(1).value();
    const auto writer = std::move(make_writer(stranger, Topic::front, "good")).value();
    ASSERT_TRUE(eventually([&] { return is_matched(writer); }));
    ASSERT_TRUE(eventually(
        [&]
        {
            for (std::uint32_t i = 0; i < 100; ++i)
            {
                tactus_v4_Front sample = {};
                std::memcpy(sample.controller, &i, sizeof(i));
                std::strcpy(static_cast<char*>(sample.controller_name), "many");
                dds_write(writer.handle, &sample);
            }
            good->write(some_front(1, 1, 1, 1));
            sut_->poll();
            return !sut_->fronts().empty();
        }));
    EXPECT_EQ(sut_->fronts().size(), 1U);
    EXPECT_EQ(sut_->fronts()[0].id, controller.participants().own());
}

TEST_F(DdsFront, with_a_fault_in_it_is_refused)
{
    using Sample = tactus_v4_Front;
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::function<void(Sample&)>> faults{
        [](Sample& s) { std::strcpy(static_cast<char*>(s.controller_name), "two words"); },
        [](Sample& s) { s.times[6].max_ns = kNan; },
        [](Sample& s) { s.times[0].mean_ns = -1.0; },
        [](Sample& s) { s.sweep_begin = 5; },
        [](Sample& s) { s.sweep_end = kMaxObjects + 1; },
        [](Sample& s) { s.tools._buffer[0].state = kSafetyStates; },
        [](Sample& s) { s.tools._buffer[0].causes = 1U << kForceOffs; },
        [](Sample& s) { s.tools._buffer[0].radius_m = kNan; },
        [](Sample& s) { std::strcpy(static_cast<char*>(s.tools._buffer[0].shape), "\x1b[31m"); },
        [](Sample& s) { s.objects._buffer[0].model = 1; },
        [](Sample& s) { s.objects._buffer[0].number = kMaxObjects; },
        [](Sample& s) { s.objects._buffer[0].pose.rotation[0] = 1.0; },
        [](Sample& s) { s.objects._buffer[0].pose.translation_m[2] = kNan; },
        [](Sample& s) { s.models._buffer[0].pages = 1; },
        [](Sample& s) { s.models._buffer[0].pages = 0xFFFF'FFFFU; },
        [](Sample& s) { s.refined._length = 1; },
        [](Sample& s) { s.chunks._buffer[1] = s.chunks._buffer[0]; },
        [](Sample& s) { s.chunks._buffer[1] = 0xFFFF'FFFFU; },
        [](Sample& s) { s.models._buffer[0].wished = 1; },
        [](Sample& s) { s.models._buffer[0].wished = 0xFFFF'FFFFU; },
        [](Sample& s) { s.wished._buffer[1] = s.wished._buffer[0]; },
        [](Sample& s) { s.wished._buffer[1] = 0xFFFF'FFFFU; },
        [](Sample& s) { s.regions._buffer[0].model = 1; },
        [](Sample& s) { s.regions._buffer[0].center_m[1] = static_cast<float>(kNan); },
        [](Sample& s) { s.regions._buffer[0].radius_m = static_cast<float>(kNan); },
        [](Sample& s) { s.regions._buffer[0].radius_m = -1.0F; },
    };
    const Domain controller = Domain::join(1).value();
    const ControllerId id = controller.participants().own();
    const auto writer = std::move(make_writer(controller, Topic::front, "good")).value();
    ASSERT_TRUE(eventually([&] { return is_matched(writer); }));
    for (std::size_t i = 0; i <= faults.size(); ++i)
    {
        tactus_v4_FrontTool tool = {};
        tactus_v4_FrontModel model = {};
        tactus_v4_FrontObject object = {};
        std::array<std::uint32_t, 2> chunks{3, 4};
        std::array<std::uint64_t, 2> refined{};
        std::array<std::uint32_t, 2> wished{5, 6};
        tactus_v4_FrontRegion region = {};
        model.pages = 2;
        model.wished = 2;
        object.pose.rotation[3] = 1.0;
        object.pose.scale = 1.0;
        Sample sample = {};
        std::memcpy(sample.controller, id.data(), id.size());
        std::strcpy(static_cast<char*>(sample.controller_name), "good");
        sample.tools = {1, 1, &tool, false};
        sample.models = {1, 1, &model, false};
        sample.objects = {1, 1, &object, false};
        sample.chunks = {2, 2, chunks.data(), false};
        sample.refined = {2, 2, refined.data(), false};
        sample.wished = {2, 2, wished.data(), false};
        sample.regions = {1, 1, &region, false};
        const bool is_good = i == faults.size();
        if (!is_good)
        {
            faults[i](sample);
        }
        const std::uint64_t before = sut_->refused();
        EXPECT_TRUE(eventually(
            [&]
            {
                dds_write(writer.handle, &sample);
                sut_->poll();
                return is_good ? !sut_->fronts().empty() : sut_->refused() > before;
            }))
            << i;
        EXPECT_EQ(sut_->fronts().empty(), !is_good) << i;
    }
}

} // namespace
} // namespace tactus::dds
