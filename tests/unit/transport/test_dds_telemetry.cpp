// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/infinity.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "transport/dds/telemetry.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>
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
Telemetry some_telemetry(std::uint32_t tools, std::uint32_t models, std::uint32_t pairs = 0)
{
    Telemetry telemetry;
    double number = 0.5;
    const auto vector = [&] { return std::array{number += 1.0, number += 1.0, number += 1.0}; };
    std::uint32_t count = 10;
    telemetry.frame = count++;
    telemetry.period_ns = count++;
    telemetry.time_ns = -static_cast<std::int64_t>(count++);
    telemetry.exact = count++;
    telemetry.decided = count++;
    telemetry.bracket = count++;
    telemetry.stale = count++;
    telemetry.missed = count++;
    telemetry.own_faults = count++;
    telemetry.machine_late = count++;
    telemetry.faults_now = count++;
    telemetry.faults_seen = count++;
    telemetry.tool_count = tools;
    telemetry.model_count = models;
    for (std::uint32_t i = 0; i < tools; ++i)
    {
        ToolTelemetry& tool = telemetry.tools[i];
        tool.position_m = vector();
        tool.rotation = {0.5, -0.5, 0.5, number += 1.0};
        tool.proxy_m = vector();
        tool.proxy_rotation = {-0.5, 0.5, 0.5, number += 1.0};
        tool.force_n = vector();
        tool.torque_nm = vector();
        tool.gripper_m = 0.25 * i;
        tool.buttons = 7 * i;
        tool.has_gripper = i == 1;
        tool.in_contact = i == 0;
        tool.frozen = (i & 1U) != 0;
        tool.squeezed = (i & 2U) != 0;
        tool.held_back = i == 3;
    }
    telemetry.pair_count = pairs;
    for (std::uint32_t i = 0; i < pairs; ++i)
    {
        telemetry.pairs[i] = {std::uint64_t{i} << 40U,
                              1'000 + i,
                              static_cast<std::uint8_t>(i % tools),
                              static_cast<AnswerKind>(i % 4),
                              -0.5 * i,
                              i % 7 == 0 ? kInfinity : 0.5 * i,
                              vector(),
                              vector()};
    }
    for (std::uint32_t i = 0; i < models; ++i)
    {
        ModelTelemetry& model = telemetry.models[i];
        for (PoolTelemetry* pool : {&model.pages, &model.faces, &model.blocks, &model.nodes})
        {
            *pool = {count, count + 1};
            count += 2;
        }
        model.host_gone = (i & 1U) != 0;
        model.is_static = (i & 2U) != 0;
        model.follows_poses = (i & 4U) != 0;
        model.stage = static_cast<ModelStage>(i % kModelStages);
        model.pose_age_ns = count++;
        model.poses_refused = count++;
        model.pieces = count++;
        model.piece_wait_ns = count++;
    }
    return telemetry;
}

std::vector<ModelIdentity> some_models(std::uint32_t count)
{
    std::vector<ModelIdentity> models;
    for (std::uint32_t i = 0; i < count; ++i)
    {
        models.push_back({"model-" + std::to_string(i), {}, i + 3});
        models.back().hash.fill(static_cast<std::uint8_t>(i + 1));
    }
    return models;
}

void expect_same(const ToolTelemetry& got, const ToolTelemetry& sent)
{
    EXPECT_EQ(got.position_m, sent.position_m);
    EXPECT_EQ(got.rotation, sent.rotation);
    EXPECT_EQ(got.proxy_m, sent.proxy_m);
    EXPECT_EQ(got.proxy_rotation, sent.proxy_rotation);
    EXPECT_EQ(got.force_n, sent.force_n);
    EXPECT_EQ(got.torque_nm, sent.torque_nm);
    EXPECT_EQ(got.gripper_m, sent.gripper_m);
    EXPECT_EQ(got.has_gripper, sent.has_gripper);
    EXPECT_EQ(got.buttons, sent.buttons);
    EXPECT_EQ(got.in_contact, sent.in_contact);
    EXPECT_EQ(got.frozen, sent.frozen);
    EXPECT_EQ(got.squeezed, sent.squeezed);
    EXPECT_EQ(got.held_back, sent.held_back);
}

void expect_same(const PairTelemetry& got, const PairTelemetry& sent)
{
    EXPECT_EQ(got.host_epoch, sent.host_epoch);
    EXPECT_EQ(got.object, sent.object);
    EXPECT_EQ(got.tool, sent.tool);
    EXPECT_EQ(got.kind, sent.kind);
    EXPECT_EQ(got.lower_m, sent.lower_m);
    EXPECT_EQ(got.upper_m, sent.upper_m);
    EXPECT_EQ(got.point_m, sent.point_m);
    EXPECT_EQ(got.force_n, sent.force_n);
}

void expect_same(const ModelTelemetry& got, const ModelTelemetry& sent)
{
    for (const auto pool : {&ModelTelemetry::pages, &ModelTelemetry::faces, &ModelTelemetry::blocks,
                            &ModelTelemetry::nodes})
    {
        EXPECT_EQ((got.*pool).used, (sent.*pool).used);
        EXPECT_EQ((got.*pool).capacity, (sent.*pool).capacity);
    }
    EXPECT_EQ(got.host_gone, sent.host_gone);
    EXPECT_EQ(got.is_static, sent.is_static);
    EXPECT_EQ(got.follows_poses, sent.follows_poses);
    EXPECT_EQ(got.stage, sent.stage);
    EXPECT_EQ(got.pose_age_ns, sent.pose_age_ns);
    EXPECT_EQ(got.poses_refused, sent.poses_refused);
    EXPECT_EQ(got.pieces, sent.pieces);
    EXPECT_EQ(got.piece_wait_ns, sent.piece_wait_ns);
}

void expect_same(const Telemetry& got, const Telemetry& sent)
{
    EXPECT_EQ(got.frame, sent.frame);
    EXPECT_EQ(got.period_ns, sent.period_ns);
    EXPECT_EQ(got.time_ns, sent.time_ns);
    EXPECT_EQ(got.exact, sent.exact);
    EXPECT_EQ(got.decided, sent.decided);
    EXPECT_EQ(got.bracket, sent.bracket);
    EXPECT_EQ(got.stale, sent.stale);
    EXPECT_EQ(got.missed, sent.missed);
    EXPECT_EQ(got.own_faults, sent.own_faults);
    EXPECT_EQ(got.machine_late, sent.machine_late);
    EXPECT_EQ(got.faults_now, sent.faults_now);
    EXPECT_EQ(got.faults_seen, sent.faults_seen);
    ASSERT_EQ(got.tool_count, sent.tool_count);
    ASSERT_EQ(got.model_count, sent.model_count);
    for (std::uint32_t i = 0; i < sent.tool_count; ++i)
    {
        expect_same(got.tools[i], sent.tools[i]);
    }
    ASSERT_EQ(got.pair_count, sent.pair_count);
    for (std::uint32_t i = 0; i < sent.pair_count; ++i)
    {
        expect_same(got.pairs[i], sent.pairs[i]);
    }
    for (std::uint32_t i = 0; i < sent.model_count; ++i)
    {
        expect_same(got.models[i], sent.models[i]);
    }
}

class DdsTelemetry : public ::testing::Test
{
protected:
    void SetUp() override
    {
        test::isolate_domains();
        host_.emplace(Domain::join(2).value());
        sut_ = std::move(TelemetryReader::create(*host_)).value();
    }
    /// A controller is a participant: each is one of its own.
    struct Controller
    {
        Domain domain{Domain::join(1).value()};
        std::unique_ptr<TelemetryWriter> writer;
    };
    static std::unique_ptr<Controller> make_controller(const std::string& name,
                                                       std::uint32_t models)
    {
        auto controller = std::make_unique<Controller>();
        controller->writer =
            std::move(TelemetryWriter::create(controller->domain, name, some_models(models)))
                .value();
        return controller;
    }

    std::optional<Domain> host_;
    std::unique_ptr<TelemetryReader> sut_;
};

TEST_F(DdsTelemetry, comes_as_it_was_sent)
{
    struct Size
    {
        std::uint32_t tools;
        std::uint32_t models;
        std::uint32_t pairs;
    };
    for (const Size size :
         {Size{0, 0, 0}, Size{1, 1, 1}, Size{kMaxTools, kMaxShownModels, kMaxPairs}})
    {
        const std::uint32_t models = size.models;
        const auto controller = make_controller("one", models);
        const Telemetry sent = some_telemetry(size.tools, models, size.pairs);
        ASSERT_TRUE(eventually(
            [&]
            {
                controller->writer->write(sent);
                sut_->poll();
                return sut_->controllers().size() == 1 &&
                       sut_->controllers()[0].models.size() == models;
            }));
        const WatchedController& got = sut_->controllers()[0];
        EXPECT_EQ(got.name, "one");
        EXPECT_GT(got.serial, 0U);
        EXPECT_LE(got.serial, controller->writer->sent());
        expect_same(got.telemetry, sent);
        for (std::uint32_t i = 0; i < models; ++i)
        {
            EXPECT_EQ(got.models[i].name, some_models(models)[i].name);
            EXPECT_EQ(got.models[i].hash, some_models(models)[i].hash);
            EXPECT_EQ(got.models[i].revision, some_models(models)[i].revision);
        }
    }
    EXPECT_EQ(sut_->refused(), 0U);
}

TEST_F(DdsTelemetry, of_a_controller_that_leaves_is_forgotten)
{
    auto staying = make_controller("staying", 1);
    auto leaving = make_controller("leaving", 1);
    const auto see = [&](std::size_t count)
    {
        return eventually(
            [&]
            {
                for (const auto* controller : {&staying, &leaving})
                {
                    if (*controller != nullptr)
                    {
                        (*controller)->writer->write(some_telemetry(1, 1));
                    }
                }
                sut_->poll();
                return sut_->controllers().size() == count;
            });
    };
    ASSERT_TRUE(see(2));
    leaving.reset();
    ASSERT_TRUE(see(1));
    EXPECT_EQ(sut_->controllers()[0].name, "staying");
}

/// 70 at once, each of which goes on as if it were alone.
TEST_F(DdsTelemetry, of_more_than_64_controllers_is_watched_at_once)
{
    std::vector<std::unique_ptr<Controller>> controllers;
    for (int i = 0; i < 70; ++i)
    {
        controllers.push_back(make_controller("hrtc-" + std::to_string(i), 1));
    }
    EXPECT_TRUE(eventually(
        [&]
        {
            for (const auto& controller : controllers)
            {
                controller->writer->write(some_telemetry(1, 1));
            }
            sut_->poll();
            return sut_->controllers().size() == controllers.size();
        }));
    EXPECT_EQ(sut_->refused(), 0U);
}

/// One writer may say that it is another, or many: none of that gets into the reader.
TEST_F(DdsTelemetry, of_a_controller_that_it_does_not_come_from_is_not_heard)
{
    const auto controller = make_controller("good", 0);
    const Domain stranger = Domain::join(1).value();
    const auto writer = std::move(make_writer(stranger, Topic::telemetry, "good")).value();
    ASSERT_TRUE(eventually([&] { return is_matched(writer); }));
    ASSERT_TRUE(eventually(
        [&]
        {
            for (std::uint32_t i = 0; i < 100; ++i)
            {
                tactus_v4_Telemetry sample = {};
                std::memcpy(sample.controller, &i, sizeof(i));
                std::strcpy(static_cast<char*>(sample.controller_name), "many");
                dds_write(writer.handle, &sample);
            }
            controller->writer->write(some_telemetry(1, 0));
            sut_->poll();
            return !sut_->controllers().empty();
        }));
    EXPECT_EQ(sut_->controllers().size(), 1U);
    EXPECT_EQ(sut_->controllers()[0].name, "good");
    EXPECT_EQ(sut_->refused(), 0U);
}

TEST_F(DdsTelemetry, with_a_fault_in_it_is_refused)
{
    using Sample = tactus_v4_Telemetry;
    const auto name = [](char* text, const char* value) { std::strcpy(text, value); };
    const std::vector<std::function<void(Sample&)>> faults{
        [&](Sample& s) { name(static_cast<char*>(s.controller_name), ""); },
        [&](Sample& s) { name(static_cast<char*>(s.controller_name), "two words"); },
        [&](Sample& s) { name(static_cast<char*>(s.controller_name), "\x1b[31mred"); },
        [&](Sample& s) { name(static_cast<char*>(s.models._buffer[0].name), "a\nb"); },
        [](Sample& s) { s.tools._buffer[0].force_n[1] = std::numeric_limits<double>::quiet_NaN(); },
        [](Sample& s)
        { s.tools._buffer[0].position_m[0] = std::numeric_limits<double>::infinity(); },
        [](Sample& s) { s.tools._buffer[0].gripper_m = std::numeric_limits<double>::quiet_NaN(); },
        [](Sample& s) { s.tools._buffer[0].rotation[3] = std::numeric_limits<double>::infinity(); },
        [](Sample& s) { s.pairs._buffer[0].tool = 1; },
        [](Sample& s) { s.pairs._buffer[0].kind = 4; },
        [](Sample& s) { s.pairs._buffer[0].upper_m = std::numeric_limits<double>::quiet_NaN(); },
        [](Sample& s) { s.pairs._buffer[0].upper_m = -1.0; },
        [](Sample& s) { s.pairs._buffer[0].force_n[2] = std::numeric_limits<double>::infinity(); },
    };
    const Domain controller = Domain::join(1).value();
    const ControllerId id = controller.participants().own();
    const auto writer = std::move(make_writer(controller, Topic::telemetry, "good")).value();
    ASSERT_TRUE(eventually([&] { return is_matched(writer); }));
    for (std::size_t i = 0; i <= faults.size(); ++i)
    {
        tactus_v4_ToolTelemetry tool = {};
        tactus_v4_PairTelemetry pair = {};
        tactus_v4_ModelTelemetry model = {};
        name(static_cast<char*>(model.name), "tiny");
        Sample sample = {};
        std::memcpy(sample.controller, id.data(), id.size());
        name(static_cast<char*>(sample.controller_name), "good");
        sample.tools = {1, 1, &tool, false};
        sample.pairs = {1, 1, &pair, false};
        sample.models = {1, 1, &model, false};
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
                return is_good ? !sut_->controllers().empty() : sut_->refused() > before;
            }))
            << i;
        EXPECT_EQ(sut_->controllers().empty(), !is_good) << i;
    }
}

TEST_F(DdsTelemetry, that_holds_more_than_its_bounds_never_leaves)
{
    const Domain controller = Domain::join(1).value();
    const auto writer = std::move(make_writer(controller, Topic::telemetry, "long")).value();
    std::vector<tactus_v4_ToolTelemetry> tools(kMaxTools + 1);
    tactus_v4_Telemetry sample = {};
    std::strcpy(static_cast<char*>(sample.controller_name), "long");
    sample.tools = {kMaxTools + 1, kMaxTools + 1, tools.data(), false};
    EXPECT_NE(dds_write(writer.handle, &sample), DDS_RETCODE_OK);
}

} // namespace
} // namespace tactus::dds
