// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/live_state.hpp"
#include "host_tools/spm_view/state_text.hpp"
#include "tests/unit/host_view/live_rig.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace tactus::view
{
namespace
{

using test::state;
using test::told;

TEST(LiveState, keeps_the_states_of_a_minute_and_no_more)
{
    LiveState sut;
    const std::string id = id_text(told(1, "one").id);
    for (std::uint64_t serial = 1; serial <= LiveState::kStates + 1; ++serial)
    {
        sut.publish({told(1, "one", serial, state())});
        const std::uint64_t news = sut.newest()->serial;
        sut.publish({told(1, "one", serial, state())}); // No change.
        EXPECT_EQ(sut.newest()->serial, news);
    }
    EXPECT_EQ(sut.state(id, 1), nullptr);
    ASSERT_NE(sut.state(id, 2), nullptr);
    EXPECT_EQ(sut.state(id, LiveState::kStates + 1)->serial, LiveState::kStates + 1);
    EXPECT_EQ(sut.state("another", 2), nullptr);
    const std::uint64_t before = sut.newest()->serial;
    sut.publish({});
    EXPECT_EQ(sut.state(id, 2), nullptr);
    EXPECT_GT(sut.newest()->serial, before) << "it has gone";
}

TEST(LiveState, keeps_no_more_bytes_than_it_may)
{
    LiveState sut;
    RefinementState large = state();
    large.models.emplace_back().pages.resize(kMaxStatePages);
    const std::size_t least = kMaxStatePages * sizeof(RefinementStatePage);
    std::size_t kept = 0;
    std::vector<dds::WatchedController> all;
    for (std::uint64_t serial = 1; serial <= LiveState::kStates; ++serial)
    {
        all.clear();
        for (std::uint8_t id = 1; id <= 4; ++id)
        {
            all.push_back(told(id, "one", serial, large));
        }
        sut.publish(all);
    }
    for (const dds::WatchedController& each : all)
    {
        for (std::uint64_t serial = 1; serial <= LiveState::kStates; ++serial)
        {
            kept += sut.state(id_text(each.id), serial) != nullptr ? 1U : 0U;
        }
    }
    EXPECT_GT(kept, 4U);
    EXPECT_LE(kept * least, LiveState::kStateBytes);
}

TEST(LiveState, gathers_objects_turn_by_turn_and_forgets_those_that_went)
{
    LiveState sut;
    dds::WatchedController one = told(1, "one");
    const auto publish = [&](std::uint32_t begin, std::vector<std::uint32_t> numbers)
    {
        ++one.serial;
        one.objects = {begin, begin + 2, {}};
        for (const std::uint32_t number : numbers)
        {
            one.objects.objects.emplace_back().number = number;
        }
        sut.publish({one});
        std::vector<std::uint32_t> there;
        for (const ObjectTelemetry& each : sut.newest()->controllers[0].objects)
        {
            there.push_back(each.number);
        }
        return there;
    };
    EXPECT_EQ(publish(0, {0, 1}), (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(publish(2, {3, 1}), (std::vector<std::uint32_t>{0, 1, 3}));
    EXPECT_EQ(publish(0, {1}), (std::vector<std::uint32_t>{1, 3}));
    EXPECT_EQ(publish(2, {}), (std::vector<std::uint32_t>{1}));
    sut.publish({});
    EXPECT_EQ(publish(2, {}), (std::vector<std::uint32_t>{})) << "it came again";
}

TEST(StateJson, says_what_it_waits_for)
{
    const auto shelf = std::move(ModelShelf::open({})).value();
    LiveState live;
    const auto waits = [&](const std::string& chosen = "")
    {
        return nlohmann::json::parse(state_json(*live.newest(), *shelf, chosen, 7))["waits_for"]
            .get<std::string>();
    };
    EXPECT_EQ(waits(), "a controller on DDS domain 7: start 'hrtc --model NAME --domain 7' or "
                       "'hrtc FILE --domain 7' (with FILE, viewers need --domain)");
    live.publish({told(1, "one")});
    EXPECT_NE(waits().find("--no-refinement-state"), std::string::npos);
    EXPECT_NE(waits("01").find("disconnected"), std::string::npos);
    dds::WatchedController one = told(1, "one", 1, state());
    live.publish({one});
    EXPECT_EQ(waits(), "");
    RefinementState refined = state();
    refined.models.emplace_back().hash.fill(0xAB);
    live.publish({told(1, "one", 2, refined)});
    EXPECT_NE(waits().find("abababab"), std::string::npos);
    one.serial = 3;
    one.objects.objects.emplace_back().model.fill(0xCD);
    live.publish({one});
    EXPECT_NE(waits().find("cdcdcdcd"), std::string::npos) << "a model without pages";
}

TEST(StateJson, shows_the_chosen_controller_and_lists_all)
{
    const auto shelf = std::move(ModelShelf::open({})).value();
    LiveState live;
    RefinementState shown = state();
    RefinementStateModel& model = shown.models.emplace_back();
    model.hash.fill(0xAB);
    model.requested = {{3}, {7}};
    shown.regions = {{0, true, {0.5F, 1.0F, 2.0F}, 0.25F}};
    shown.regions_left_out = 6;
    shown.slots_left_out = 7;
    dds::WatchedController two = told(2, "two", 5, shown);
    ObjectTelemetry& object = two.objects.objects.emplace_back();
    object.number = object.object = 0;
    object.name = "cup";
    object.model.fill(0xCD);
    object.pose.translation_m = {1.0, 2.0, 3.0};
    two.objects.sweep_end = 1;
    live.publish({told(1, "one"), two});
    const auto state =
        nlohmann::json::parse(state_json(*live.newest(), *shelf, id_text(two.id), 0));
    EXPECT_EQ(state["controllers"].size(), 2U);
    EXPECT_EQ(state["controller"]["name"], "two");
    EXPECT_EQ(state["controller"]["front"]["serial"], 5);
    ASSERT_EQ(state["controller"]["front"]["models"].size(), 2U);
    EXPECT_EQ(state["controller"]["front"]["models"][0]["requested"], 2);
    EXPECT_EQ(state["controller"]["front"]["models"][1]["hash"],
              std::string("cdcdcdcd") + "cdcdcdcdcdcdcdcdcdcdcdcd");
    ASSERT_EQ(state["controller"]["front"]["objects"].size(), 1U);
    EXPECT_EQ(state["controller"]["front"]["objects"][0]["name"], "cup");
    EXPECT_EQ(state["controller"]["front"]["objects"][0]["translation_m"],
              (std::vector<double>{1.0, 2.0, 3.0}));
    EXPECT_EQ(state["controller"]["front"]["regions_left_out"], 6);
    EXPECT_EQ(state["controller"]["front"]["slots_left_out"], 7);
    EXPECT_EQ(state["controller"]["front"]["regions"],
              nlohmann::json::parse(R"([{"model": "abababababababababababababababab",
                  "is_predicted": true, "center_m": [0.5, 1.0, 2.0], "radius_m": 0.25}])"));
    EXPECT_EQ(state["controller"]["tools"][0]["words"], "on: no contact, so the force is zero");
    EXPECT_TRUE(state["controller"]["pairs"][0]["upper_m"].is_null());
}

TEST(ForceWords, name_every_cause_and_what_brings_the_force_back)
{
    ToolTelemetry tool;
    tool.in_contact = true;
    EXPECT_EQ(force_words({SafetyState::force, ForceOff::none, "", 0.0}, tool, {}), "on");
    const std::string inside =
        "the tool began inside a closed object, whose surface keeps it inside";
    const RefinementStateTool began{SafetyState::force, ForceOff::none, "", 0.0, true};
    EXPECT_EQ(force_words(began, tool, {}), "on: " + inside);
    EXPECT_EQ(force_words(began, {}, {}), "on: no contact, so the force is zero; " + inside);
    std::vector<std::string> all;
    for (std::size_t cause = 0; cause < kForceOffs; ++cause)
    {
        const auto one = static_cast<ForceOff>(1U << cause);
        const std::string words = force_words({SafetyState::brake, one, "", 0.0}, tool, {});
        EXPECT_TRUE(words.starts_with("off: ")) << words;
        EXPECT_NE(words.find("; returns "), std::string::npos) << words;
        EXPECT_EQ(std::ranges::count(all, words), 0) << words;
        all.push_back(words);
    }
    ModelTelemetry gone;
    gone.server_gone = true;
    gone.pose_age_ns = 600'000'000;
    const std::vector models{gone};
    EXPECT_EQ(force_words({SafetyState::brake, ForceOff::server | ForceOff::stall, "", 0.0}, tool,
                          models),
              "off: frames were missed; returns when frames are in time again. Also: the server "
              "has been silent for 0.6 s; returns when the model is served again");
}

TEST(Metrics, are_text_that_prometheus_reads)
{
    LiveState live;
    live.publish({told(1, "one"), told(2, "two")});
    const std::string text = metrics_text(*live.newest());
    EXPECT_NE(text.find("tactus_controllers 2\n"), std::string::npos);
    EXPECT_NE(text.find("# TYPE tactus_force_newtons gauge\n"
                        "tactus_force_newtons{controller=\"one\",id=\"01010101010101010101010101"
                        "010101\"} 5\n"),
              std::string::npos)
        << text;
    EXPECT_TRUE(text.ends_with("\n"));
}

} // namespace
} // namespace tactus::view
