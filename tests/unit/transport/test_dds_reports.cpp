// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Laws of a controller's telemetry in transit, with a refinement state as its optional part.

#include "rt_core/math/infinity.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "transport/dds/telemetry.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <array>
#include <concepts>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tactus.h"

namespace tactus::dds
{
namespace
{

using test::eventually;
using test::kNan;

/// Size of a report.
struct Size
{
    std::uint32_t tools, models, pairs, objects, state_models, pages;
};

constexpr Size kNothing{0, 0, 0, 0, 0, 0};
constexpr Size kSmall{1, 1, 1, 1, 1, 1};
constexpr Size kLargest{kMaxTools,        kMaxShownModels, kMaxPairs,
                        kMaxShownObjects, kMaxModels,      kMaxStatePages};

/// Different numbers, and flags that differ between records.
struct Distinct
{
    template <typename... Fields>
    void fill(Fields&... fields)
    {
        (set(fields), ...);
    }
    template <typename Number>
    [[nodiscard]] Number next()
    {
        Number number{};
        set(number);
        return number;
    }

private:
    void set(bool& flag) { flag = ((++count_ * 0x9E37'79B1U) >> 31U) != 0; }
    void set(std::integral auto& number)
    {
        number = static_cast<std::remove_reference_t<decltype(number)>>(++count_);
    }
    void set(std::floating_point auto& number)
    {
        number = static_cast<std::remove_reference_t<decltype(number)>>(++count_) / 4;
    }
    template <typename Number, std::size_t kCount>
    void set(std::array<Number, kCount>& numbers)
    {
        for (Number& number : numbers)
        {
            set(number);
        }
    }
    void set(PoolTelemetry& pool)
    {
        auto& [used, capacity] = pool;
        fill(used, capacity);
    }
    void set(FrontTimes& times)
    {
        auto& [mean_ns, max_ns] = times;
        fill(mean_ns, max_ns);
    }

    std::uint32_t count_{0};
};

// A record with an additional field has another number of names below, which does not compile.

Telemetry telemetry_of(const Size& size)
{
    Telemetry telemetry;
    Distinct distinct;
    auto& [frame, period_ns, time_ns, exact, separated, bounded, stale, within_tolerance, missed,
           overruns, latency_misses, faults_now, faults_seen, tool_count, pair_count, model_count,
           tools, pairs, models] = telemetry;
    distinct.fill(frame, period_ns, time_ns, exact, separated, bounded, stale, within_tolerance,
                  missed, overruns, latency_misses, faults_now, faults_seen);
    time_ns = -time_ns;
    tool_count = size.tools;
    pair_count = size.pairs;
    model_count = size.models;
    for (std::uint32_t i = 0; i < size.tools; ++i)
    {
        auto& [position_m, rotation, proxy_m, proxy_rotation, force_n, torque_nm, gripper_m,
               buttons, has_gripper, in_contact, halted, over_constrained, data_limited] = tools[i];
        distinct.fill(position_m, rotation, proxy_m, proxy_rotation, force_n, torque_nm, gripper_m,
                      buttons, has_gripper, in_contact, halted, over_constrained, data_limited);
    }
    for (std::uint32_t i = 0; i < size.pairs; ++i)
    {
        auto& [server_epoch, object, tool, kind, lower_m, upper_m, point_m, force_n] = pairs[i];
        distinct.fill(server_epoch, object, lower_m, upper_m, point_m, force_n);
        server_epoch <<= 40U;
        tool = static_cast<std::uint8_t>(i % size.tools);
        kind = static_cast<AnswerKind>(i % 5);
        lower_m = -lower_m;
        upper_m = i % 7 == 0 ? kInfinity : upper_m;
    }
    for (std::uint32_t i = 0; i < size.models; ++i)
    {
        auto& [pages, faces, blocks, nodes, stage, server_gone, is_static, follows_poses,
               pose_age_ns, poses_refused, pieces, piece_wait_ns] = models[i];
        distinct.fill(pages, faces, blocks, nodes, server_gone, is_static, follows_poses,
                      pose_age_ns, poses_refused, pieces, piece_wait_ns);
        stage = static_cast<ModelStage>(i % kModelStages);
    }
    return telemetry;
}

ObjectsTelemetry objects_of(const Size& size)
{
    ObjectsTelemetry shown{40, 56, {}};
    Distinct distinct;
    for (std::uint32_t i = 0; i < size.objects; ++i)
    {
        auto& [server_epoch, object, number, name, model, pose] = shown.objects.emplace_back();
        distinct.fill(server_epoch, object, model, pose.translation_m);
        server_epoch <<= 40U;
        number = 4'095 - i;
        name.assign(i % (kMaxNameBytes + 1), 'n');
        pose.rotation = {0.0, 0.6, 0.0, 0.8};
        pose.scale = 1.0 + i;
    }
    return shown;
}

std::vector<ModelIdentity> identities(std::uint32_t count)
{
    std::vector<ModelIdentity> models;
    for (std::uint32_t i = 0; i < count; ++i)
    {
        models.push_back({"model-" + std::to_string(i), {}, i + 3});
        models.back().hash.fill(static_cast<std::uint8_t>(i + 1));
    }
    return models;
}

RefinementState refinement_state_of(const Size& size)
{
    RefinementState state;
    Distinct distinct;
    distinct.fill(state.frame, state.times, state.slots_left_out, state.regions_left_out);
    auto& [splits, merges, scanned, nodes, triangles, looked_at, requests, regions, planes, work] =
        state.budgets; // `planes` is not transmitted.
    distinct.fill(splits, merges, scanned, nodes, triangles, looked_at, requests, regions, work);
    for (std::uint32_t i = 0; i < size.tools; ++i)
    {
        state.tools.push_back({static_cast<SafetyState>(i % kSafetyStates),
                               static_cast<ForceOff>(1U << (i % kForceOffs)),
                               std::string(i % (kMaxShapeBytes + 1), 's'), distinct.next<double>(),
                               i % 3 == 1});
    }
    for (std::uint32_t i = 0; i < size.state_models; ++i)
    {
        RefinementStateModel& model = state.models.emplace_back();
        model.hash.fill(static_cast<std::uint8_t>(i + 1));
        const std::uint32_t each = size.pages / size.state_models;
        const std::uint32_t share = i + 1 < size.state_models ? each : size.pages - i * each;
        for (std::uint32_t page = 0; page < share; ++page)
        {
            model.pages.push_back({{3 * page + 1}, distinct.next<std::uint64_t>() << 20U});
        }
        for (std::uint32_t request = 0; request < kMaxStateRequests / size.state_models; ++request)
        {
            model.requested.push_back({3 * request + 2});
        }
    }
    for (std::uint32_t i = 0; size.state_models > 0 && i < kMaxStateRegions; ++i)
    {
        auto& [model, is_predicted, center_m, radius_m] = state.regions.emplace_back();
        distinct.fill(is_predicted, center_m, radius_m);
        model = i % size.state_models;
        center_m[1] = -center_m[1];
    }
    return state;
}

/// Wire sample with one record of each kind, valid except for a test's change.
struct ReportSample
{
    tactus_v5_ToolTelemetry tool = {};
    tactus_v5_PairTelemetry pair = {};
    tactus_v5_ModelTelemetry model = {};
    tactus_v5_ObjectTelemetry object = {};
    tactus_v5_RefinementStateTool shown_tool = {};
    tactus_v5_RefinementStateModel state_model = {};
    std::array<std::uint32_t, 2> chunks{3, 4};
    std::array<std::uint64_t, 2> refined{};
    std::array<std::uint32_t, 2> requested{5, 6};
    tactus_v5_RefinementStateRegion region = {};
    tactus_v5_RefinementState state = {};
    tactus_v5_Telemetry sample = {};

    ReportSample()
    {
        std::strcpy(static_cast<char*>(model.name), "tiny");
        sample.tools = {1, 1, &tool, false};
        sample.pairs = {1, 1, &pair, false};
        object.pose.rotation[3] = 1.0;
        object.pose.scale = 1.0;
        sample.models = {1, 1, &model, false};
        sample.objects = {1, 1, &object, false};
        state_model.pages = 2;
        state_model.requested = 2;
        state.tools = {1, 1, &shown_tool, false};
        state.models = {1, 1, &state_model, false};
        state.chunks = {2, 2, chunks.data(), false};
        state.refined = {2, 2, refined.data(), false};
        state.requested = {2, 2, requested.data(), false};
        state.regions = {1, 1, &region, false};
        sample.refinement_state = {1, 1, &state, false};
    }
};

using S = ReportSample;
const std::vector<void (*)(S&)> kReportFaults{
    [](S& s) { std::strcpy(static_cast<char*>(s.sample.controller_name), ""); },
    [](S& s) { std::strcpy(static_cast<char*>(s.sample.controller_name), "\x1b[31mred"); },
    [](S& s) { std::strcpy(static_cast<char*>(s.model.name), "a\nb"); },
    [](S& s) { s.tool.force_n[1] = kNan; },
    [](S& s) { s.tool.position_m[0] = kInfinity; },
    [](S& s) { s.tool.gripper_m = kNan; },
    [](S& s) { s.tool.rotation[3] = kInfinity; },
    [](S& s) { s.pair.tool = 1; },
    [](S& s) { s.pair.kind = 5; },
    [](S& s) { s.pair.upper_m = kNan; },
    [](S& s) { s.pair.upper_m = -1.0; },
    [](S& s) { s.pair.force_n[2] = kInfinity; },
    [](S& s) { s.sample.sweep_begin = 5; },
    [](S& s) { s.sample.sweep_end = kMaxObjects + 1; },
    [](S& s) { s.object.number = kMaxObjects; },
    [](S& s) { s.object.pose.rotation[0] = 1.0; },
    [](S& s) { s.object.pose.translation_m[2] = kNan; },
    [](S& s) { std::strcpy(static_cast<char*>(s.object.name), "\x1b[31m"); },
    [](S& s) { s.state.times[6].max_ns = kNan; },
    [](S& s) { s.state.times[0].mean_ns = -1.0; },
    [](S& s) { s.shown_tool.state = kSafetyStates; },
    [](S& s) { s.shown_tool.causes = 1U << kForceOffs; },
    [](S& s) { s.shown_tool.radius_m = kNan; },
    [](S& s) { std::strcpy(static_cast<char*>(s.shown_tool.shape), "\x1b[31m"); },
    [](S& s) { s.state_model.pages = 1; },
    [](S& s) { s.state_model.pages = 0xFFFF'FFFFU; },
    [](S& s) { s.state.refined._length = 1; },
    [](S& s) { s.chunks[1] = s.chunks[0]; },
    [](S& s) { s.chunks[1] = 0xFFFF'FFFFU; },
    [](S& s) { s.state_model.requested = 1; },
    [](S& s) { s.state_model.requested = 0xFFFF'FFFFU; },
    [](S& s) { s.requested[1] = s.requested[0]; },
    [](S& s) { s.requested[1] = 0xFFFF'FFFFU; },
    [](S& s) { s.region.model = 1; },
    [](S& s) { s.region.center_m[1] = static_cast<float>(kNan); },
    [](S& s) { s.region.radius_m = static_cast<float>(kNan); },
    [](S& s) { s.region.radius_m = -1.0F; },
    [](S& s) { std::strcpy(static_cast<char*>(s.sample.controller_name), "two words"); },
};

struct DdsTelemetry : ::testing::Test
{
    void SetUp() override
    {
        test::isolate_domains();
        viewer_.emplace(Domain::join(2).value());
        sut_ = std::move(TelemetryReader::create(*viewer_, true)).value();
    }
    /// A controller is a participant: each has its own.
    struct Controller
    {
        Controller(const std::string& name, const Size& size)
            : writer(
                  std::move(TelemetryWriter::create(domain, name, identities(size.models))).value())
            , telemetry(telemetry_of(size))
            , objects(objects_of(size))
            , state(refinement_state_of(size))
        {
        }
        void write() { writer->write(telemetry, objects, &state); }

        Domain domain{Domain::join(1).value()};
        std::unique_ptr<TelemetryWriter> writer;
        Telemetry telemetry;
        ObjectsTelemetry objects;
        RefinementState state;
    };
    [[nodiscard]] const auto& seen() const { return sut_->controllers(); }
    /// Writes until the reader satisfies the condition.
    [[nodiscard]] bool polled_until(
        const std::function<bool()>& is_so, const std::function<void()>& write = [] {})
    {
        return eventually(
            [&]
            {
                write();
                sut_->poll();
                return is_so();
            });
    }

    std::optional<Domain> viewer_;
    std::unique_ptr<TelemetryReader> sut_;
};

TEST_F(DdsTelemetry, comes_as_it_was_sent_and_goes_with_its_controller)
{
    for (const Size& size : {kNothing, kSmall, kLargest})
    {
        Controller controller("one", size);
        ASSERT_TRUE(polled_until(
            [&] { // The last one's end may still be in transit.
                return seen().size() == 1 && seen()[0].id == controller.domain.participants().own();
            },
            [&] { controller.write(); }));
        const WatchedController& got = seen()[0];
        EXPECT_GT(got.serial, 0U);
        EXPECT_LE(got.serial, controller.writer->sent());
        EXPECT_EQ(controller.writer->states_sent(), controller.writer->sent());
        EXPECT_EQ(got.name, "one");
        EXPECT_EQ(got.models, identities(size.models));
        EXPECT_TRUE(got.telemetry == controller.telemetry);
        EXPECT_TRUE(got.objects == controller.objects);
        ASSERT_NE(got.state, nullptr);
        EXPECT_EQ(got.state->serial, got.serial);
        EXPECT_TRUE(got.state->state == controller.state);
    }
    EXPECT_TRUE(polled_until([&] { return seen().empty(); }));
    EXPECT_EQ(sut_->refused(), 0U);
}

TEST_F(DdsTelemetry, keeps_the_last_state_while_samples_have_none)
{
    Controller controller("one", kSmall);
    ASSERT_TRUE(polled_until([&] { return !seen().empty(); }, [&] { controller.write(); }));
    controller.write();
    const std::uint64_t with_state = controller.writer->sent();
    for (int i = 0; i < 10; ++i) // Ten samples without a state lie between two states.
    {
        controller.writer->write(controller.telemetry);
    }
    ASSERT_TRUE(polled_until([&] { return seen()[0].serial == controller.writer->sent(); }));
    EXPECT_EQ(seen()[0].state->serial, with_state);
    EXPECT_TRUE(seen()[0].objects.objects.empty());
    EXPECT_EQ(controller.writer->states_sent(), with_state);
}

TEST_F(DdsTelemetry, is_written_with_states_only_while_a_reader_wants_them)
{
    const Controller controller("one", kSmall);
    ASSERT_TRUE(eventually([&] { return controller.writer->wants_states(); }));
    sut_ = std::move(TelemetryReader::create(*viewer_)).value();
    EXPECT_TRUE(eventually([&] { return !controller.writer->wants_states(); }));
    EXPECT_TRUE(eventually([&] { return controller.writer->is_watched(); }));
    EXPECT_FALSE(controller.writer->wants_states());
}

/// A writer may claim to be another, or many: nothing of that enters the reader.
TEST_F(DdsTelemetry, of_a_controller_that_it_does_not_come_from_is_not_heard)
{
    Controller controller("good", kSmall);
    const Domain stranger = Domain::join(1).value();
    const auto writer = std::move(make_writer(stranger, Topic::telemetry, "good")).value();
    ASSERT_TRUE(eventually([&] { return is_matched(writer); }));
    ASSERT_TRUE(polled_until([&] { return !seen().empty(); },
                             [&]
                             {
                                 for (std::uint32_t i = 0; i < 100; ++i)
                                 {
                                     ReportSample lie;
                                     std::memcpy(lie.sample.controller, &i, sizeof(i));
                                     std::strcpy(static_cast<char*>(lie.sample.controller_name),
                                                 "many");
                                     dds_write(writer.handle, &lie.sample);
                                 }
                                 controller.write();
                             }));
    EXPECT_EQ(seen().size(), 1U);
    EXPECT_EQ(seen()[0].id, controller.domain.participants().own());
    EXPECT_EQ(sut_->refused(), 0U);
}

TEST_F(DdsTelemetry, with_a_fault_in_it_is_refused)
{
    const Domain controller = Domain::join(1).value();
    const ControllerId id = controller.participants().own();
    const auto writer = std::move(make_writer(controller, Topic::telemetry, "good")).value();
    ASSERT_TRUE(eventually([&] { return is_matched(writer); }));
    for (std::size_t i = 0; i <= kReportFaults.size(); ++i)
    {
        ReportSample sample;
        std::memcpy(sample.sample.controller, id.data(), id.size());
        std::strcpy(static_cast<char*>(sample.sample.controller_name), "good");
        const bool is_good = i == kReportFaults.size();
        if (!is_good)
        {
            kReportFaults[i](sample);
        }
        const std::uint64_t before = sut_->refused();
        EXPECT_TRUE(polled_until([&]
                                 { return is_good ? !seen().empty() : sut_->refused() > before; },
                                 [&] { dds_write(writer.handle, &sample.sample); }))
            << i;
        EXPECT_EQ(seen().empty(), !is_good) << i;
    }
}

/// 70 together, each of which continues as if alone, and one that stays when the others leave.
TEST_F(DdsTelemetry, of_more_than_64_controllers_is_watched_until_they_leave)
{
    std::vector<std::unique_ptr<Controller>> controllers;
    for (int i = 0; i < 70; ++i)
    {
        controllers.push_back(std::make_unique<Controller>("hrtc-" + std::to_string(i), kSmall));
    }
    const auto are_seen = [&](std::size_t count)
    {
        return polled_until([&] { return seen().size() == count; },
                            [&]
                            {
                                for (const auto& controller : controllers)
                                {
                                    controller->write();
                                }
                            });
    };
    ASSERT_TRUE(are_seen(controllers.size()));
    controllers.resize(1);
    ASSERT_TRUE(are_seen(1));
    EXPECT_EQ(seen()[0].name, "hrtc-0");
    EXPECT_EQ(sut_->refused(), 0U);
}

TEST_F(DdsTelemetry, that_holds_more_than_its_bounds_never_leaves)
{
    const Domain controller = Domain::join(1).value();
    const auto writer = std::move(make_writer(controller, Topic::telemetry, "long")).value();
    std::vector<tactus_v5_ToolTelemetry> tools(kMaxTools + 1);
    ReportSample sample;
    std::strcpy(static_cast<char*>(sample.sample.controller_name), "long");
    sample.sample.tools = {kMaxTools + 1, kMaxTools + 1, tools.data(), false};
    EXPECT_NE(dds_write(writer.handle, &sample.sample), DDS_RETCODE_OK);
}

} // namespace
} // namespace tactus::dds
