// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"
#include "platform/scene/scene_keeper.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "rt_core/frame/frame.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/store/store_link.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::hrtc
{
namespace
{

using tactus::test::eventually;
using tactus::test::small_model;

constexpr Duration kAgeLimit = milliseconds(100);

/// A model server with objects, a controller with the same two models, and the keeper between them,
/// in turns, each test in its own DDS domain. The frame's side is a mailbox that
/// the test reads.
struct SceneKeeperRig : ::testing::Test
{
    static constexpr std::uint32_t kServerDomain = 1;
    static constexpr std::uint32_t kOtherServerDomain = 2;
    static constexpr std::uint32_t kClientDomain = 3;

    void SetUp() override
    {
        tactus::test::isolate_domains();
        for (std::size_t i = 0; i < 2; ++i)
        {
            files_.push_back(small_model(i).path);
        }
        server = make_server(kServerDomain);
        client_ = std::move(dds::DdsClient::create(kClientDomain, "keeper", {})).value();
        reader_ = std::make_unique<dds::SceneReader>(client_->domain(), client_->exchange());
    }
    void TearDown() override { keeper.reset(); } // The keeper ends before its sources.
    [[nodiscard]] std::unique_ptr<dds::DdsServer> make_server(std::uint32_t domain)
    {
        std::vector<dds::PublishedModel> models;
        for (std::size_t i = 0; i < files_.size(); ++i)
        {
            models.push_back({"m" + std::to_string(i), ModelStore::open(files_[i]).value()});
        }
        auto made = dds::DdsServer::create(domain, std::move(models), {}, "workshop");
        EXPECT_TRUE(made) << made.error().text;
        return std::move(made).value();
    }
    std::uint32_t show(dds::DdsServer& shower, const std::string& name, double x_m,
                       std::size_t model = 0)
    {
        ShownObject object{name, shower.models()[model].store().hash(), {}, {}};
        object.pose.translation_m = {x_m, 0.0, 0.0};
        return shower.objects().show(object).value();
    }
    /// Starts with the server's objects, or with the first model alone without a scene.
    void start(bool follows_scene, std::uint32_t room, std::size_t models = 2)
    {
        Options options;
        options.models = {"m0", "m1"};
        options.models.resize(models);
        options.scene_materials = materials;
        options.objects_max = room;
        options.pool_mib = 8.0;
        ShownScene scene;
        if (follows_scene)
        {
            options.scene = "workshop";
            auto shown = take_shown_scene(options, *client_, *reader_,
                                          [&]
                                          {
                                              server->step();
                                              return true;
                                          });
            ASSERT_TRUE(shown) << shown.error().text;
            scene = std::move(shown).value();
        }
        else
        {
            options.objects.resize(1);
        }
        std::vector<ServedModel> served;
        for (std::size_t i = 0; i < models; ++i)
        {
            served.push_back(serve_from_file(files_[i], "m" + std::to_string(i), {}).value());
        }
        auto made = Controller::create(options, std::move(served), {}, [] { return true; });
        ASSERT_TRUE(made) << made.error().text;
        controller_ = std::move(made).value();
        const std::size_t capacity = controller_->frame().objects().capacity();
        mailbox_.emplace(controller_->poses(), capacity, kAgeLimit);
        pin(scene, models);
        keeper.emplace(authorities, std::move(reader_), controller_->scene_parts(),
                       std::move(scene), lines.log());
        keeper->connect(
            *mailbox_, now_,
            [this](std::uint32_t number, std::uint32_t generation, const std::string& name)
            { names.push_back(fmt::format("{} {} {}", number, generation, name)); });
    }
    /// Pins the server for the scene, or for each model.
    void pin(const ShownScene& scene, std::size_t models)
    {
        dds::Catalogue& catalogue = client_->catalogue();
        if (!scene.name.empty())
        {
            authorities.emplace_back(catalogue, ModelSelector{"workshop"}, true, failover,
                                     lines.log());
        }
        for (std::size_t i = 0; i < models && scene.name.empty(); ++i)
        {
            const ServedModel& model = controller_->models()[i];
            authorities.emplace_back(catalogue, ModelSelector{model.name, model.hash}, false,
                                     failover, lines.log());
        }
        ASSERT_TRUE(eventually(
            [&]
            {
                server->step();
                client_->exchange().step();
                return catalogue.offers_of(server->epoch()).size() == 2;
            }));
        for (dds::Authority& authority : authorities)
        {
            authority.pin(server->epoch());
        }
    }
    bool step_until(const std::function<bool()>& is_so, dds::DdsServer* other = nullptr)
    {
        return eventually(
            [&]
            {
                now_.ns += 1'000'000;
                for (dds::DdsServer* each : {server.get(), other})
                {
                    each != nullptr ? each->step() : void();
                }
                client_->exchange().step();
                for (dds::Authority& authority : authorities)
                {
                    authority.step();
                }
                keeper->step(now_);
                for (const SceneChange& change : mailbox_->refresh(now_))
                {
                    ++changes[change.kind];
                    last_[change.kind] = change;
                }
                return is_so();
            });
    }
    /// Object of the server at one of our places, if any.
    [[nodiscard]] std::optional<ServerObject> shown_as(std::uint32_t place) const
    {
        return keeper->shown_as(place);
    }

    /// Last added object.
    [[nodiscard]] const SceneChange& last_come() { return last_[SceneChangeKind::object_comes]; }
    [[nodiscard]] const SceneChange& last_feel() { return last_[SceneChangeKind::object_feels]; }
    [[nodiscard]] const ToolSetup& tool() { return controller_->tools().front(); }

    tactus::test::Lines lines;
    std::unique_ptr<dds::DdsServer> server;
    Failover failover;
    std::vector<dds::Authority> authorities;
    std::optional<SceneKeeper> keeper;
    std::map<SceneChangeKind, int> changes; ///< Changes as the frame would get them.
    SceneMaterials materials;               ///< Materials, set before start().
    std::vector<std::string> names;         ///< Number, generation and name of added objects.

private:
    std::map<SceneChangeKind, SceneChange> last_;
    std::vector<std::filesystem::path> files_;
    std::unique_ptr<dds::DdsClient> client_;
    std::unique_ptr<dds::SceneReader> reader_;
    std::unique_ptr<Controller> controller_;
    std::optional<SceneMailbox> mailbox_;
    MonotonicTime now_{1'000'000'000};
};

using FollowedScene = SceneKeeperRig;

TEST_F(FollowedScene, comes_moves_and_goes_through_the_door)
{
    const std::uint32_t cup = show(*server, "cup", 0.0);
    ASSERT_NO_FATAL_FAILURE(start(true, 4));
    EXPECT_EQ(shown_as(0), (ServerObject{server->epoch(), cup}));
    EXPECT_EQ(shown_as(1), std::nullopt);
    const std::uint32_t pot = show(*server, "pot", 1.0, 1);
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_comes] == 1; }));
    EXPECT_EQ(shown_as(1), (ServerObject{server->epoch(), pot}));
    EXPECT_EQ(last_come().number, 1U);
    EXPECT_EQ(last_come().object.model.value, 1U);
    Pose pose;
    pose.translation_m = {1.5, 0.0, 0.0};
    ASSERT_TRUE(server->objects().move(pot, pose));
    ASSERT_TRUE(step_until([&] { return keeper->counts(1).accepted > 1; }));
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_moves] > 0; }));
    server->objects().remove(cup);
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_goes] == 1; }));
    EXPECT_EQ(shown_as(0), std::nullopt);
    EXPECT_EQ(keeper->news().came, 1U);
    EXPECT_EQ(keeper->news().went, 1U);
    EXPECT_EQ(keeper->news().passed_over, 0U);
}

/// Values outside the ranges of --material, or with damping that leaves the device less than half
/// of its wall.
TEST_F(FollowedScene, feels_no_more_than_the_device_allows_and_tells_it_once)
{
    const std::uint32_t cup = show(*server, "cup", 0.0);
    ASSERT_NO_FATAL_FAILURE(start(true, 4));
    Material thick{9'000.0, 50.0, 40.0, 5.0, 900.0};
    ASSERT_TRUE(server->objects().feel(cup, thick));
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_feels] == 1; }));
    const Material felt = last_feel().object.material;
    EXPECT_EQ(felt.stiffness_n_per_m, 3'000.0);
    EXPECT_EQ(felt.static_friction, 3.0);
    EXPECT_EQ(felt.dynamic_friction, 3.0);
    EXPECT_EQ(felt.viscosity_n_s_per_m, 20.0);
    const DeviceLimits& device = tool().device->info().limits;
    const double period_s = tool().conditioner.period_s;
    EXPECT_GE(stiffness_limit(device, period_s, felt.damping_n_s_per_m),
              std::min(tool().spec.stiffness_n_per_m, 0.5 * stiffness_limit(device, period_s)));
    EXPECT_GT(felt.damping_n_s_per_m, 0.5 * device.damping_n_s_per_m);
    EXPECT_TRUE(lines.has("the material of object 'cup' is limited: stiffness 9000 to 3000, "
                          "static 50 to 3, dynamic 40 to 3, damping 5 to "))
        << lines.text();
    EXPECT_EQ(keeper->news().limited, 1U);
    ShownObject pot{"pot", server->models()[1].store().hash(), {}, {}};
    pot.material = thick;
    ASSERT_TRUE(server->objects().show(pot));
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_comes] == 1; }));
    EXPECT_EQ(last_come().object.material, felt);
    EXPECT_TRUE(lines.has("the material of object 'pot' is limited: ")) << lines.text();
    thick.static_friction = 60.0; // The material is unchanged.
    ASSERT_TRUE(server->objects().feel(cup, thick));
    ASSERT_TRUE(step_until([&] { return keeper->news().limited == 3; }));
    ASSERT_TRUE(server->objects().feel(cup, {}));
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_feels] == 2; }));
    EXPECT_EQ(keeper->news().limited, 3U);
    const std::string text = lines.text();
    EXPECT_EQ(text.find("object 'cup' is limited"), text.rfind("object 'cup' is limited"));
}

TEST_F(FollowedScene, feels_as_the_controller_was_told_whatever_the_server_says)
{
    ASSERT_EQ(materials.parse(std::vector<std::string>{"cup:250,0.5"}), "");
    const std::uint32_t cup = show(*server, "cup", 0.0);
    const std::uint32_t pot = show(*server, "pot", 1.0);
    ASSERT_NO_FATAL_FAILURE(start(true, 4));
    const Material honey{300.0, 0.4, 0.2, 0.5, 2.5};
    ASSERT_TRUE(server->objects().feel(cup, honey));
    ASSERT_TRUE(server->objects().feel(pot, honey));
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_feels] == 1; }));
    EXPECT_EQ(last_feel().object.material, honey);
    EXPECT_EQ(last_feel().number, 1U);
    server->objects().remove(cup);
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_goes] == 1; }));
    show(*server, "cup", 2.0);
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_comes] == 1; }));
    EXPECT_EQ(last_come().object.material, (Material{250.0, 0.5, 0.5}));
    EXPECT_EQ(keeper->news().feels, 1U);
    EXPECT_EQ(names, (std::vector<std::string>{"0 1 cup"})); // Names of later ones.
}

TEST_F(FollowedScene, leaves_out_what_has_no_room_until_there_is_some)
{
    const std::uint32_t cup = show(*server, "cup", 0.0);
    ASSERT_NO_FATAL_FAILURE(start(true, 1));
    const std::uint32_t pot = show(*server, "pot", 1.0);
    ASSERT_TRUE(step_until([&] { return keeper->news().passed_over == 1; }));
    EXPECT_TRUE(lines.has("object 'pot' can't be touched: --objects allows 1;")) << lines.text();
    EXPECT_EQ(shown_as(0), (ServerObject{server->epoch(), cup}));
    server->objects().remove(cup);
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_comes] == 1; }));
    EXPECT_EQ(changes[SceneChangeKind::object_goes], 1);
    EXPECT_EQ(shown_as(0), (ServerObject{server->epoch(), pot}));
}

TEST_F(FollowedScene, stays_and_grows_stale_when_its_server_is_gone_and_follows_no_other_one)
{
    const std::uint32_t cup = show(*server, "cup", 0.0);
    show(*server, "pot", 1.0, 1);
    ASSERT_NO_FATAL_FAILURE(start(true, 4));
    const std::uint64_t first = server->epoch();
    ASSERT_TRUE(step_until([&] { return keeper->heard(0).ns > 0; }));
    const auto second = make_server(kOtherServerDomain);
    show(*second, "jar", 2.0);
    ASSERT_TRUE(
        step_until([&] { return lines.has("scene 'workshop' is offered by a second server, "); },
                   second.get()))
        << lines.text();
    server.reset();
    ASSERT_TRUE(step_until([&] { return !authorities[0].is_resident(); }, second.get()));
    const std::int64_t heard = keeper->heard(0).ns;
    ASSERT_TRUE(step_until([&] { return lines.has("which isn't followed"); }, second.get()));
    ASSERT_TRUE(step_until([&, until = 0]() mutable { return ++until == 300; }, second.get()));
    EXPECT_EQ(keeper->heard(0).ns, heard); // The answers are therefore stale.
    EXPECT_EQ(shown_as(0), (ServerObject{first, cup}));
    EXPECT_EQ(changes[SceneChangeKind::object_goes], 0);
    EXPECT_EQ(changes[SceneChangeKind::object_comes], 0);
    EXPECT_TRUE(lines.has("its objects keep their poses and are stale")) << lines.text();
}

TEST_F(FollowedScene, goes_and_another_server_s_comes_where_failover_allows_that_one)
{
    failover.any = true;
    show(*server, "cup", 0.0);
    show(*server, "pot", 1.0, 1);
    ASSERT_NO_FATAL_FAILURE(start(true, 4));
    const std::uint64_t first = server->epoch();
    ASSERT_TRUE(step_until([&] { return keeper->heard(0).ns > 0; }));
    server.reset();
    ASSERT_TRUE(step_until([&] { return !authorities[0].is_resident(); }));
    EXPECT_EQ(changes[SceneChangeKind::object_goes], 0);
    const auto second = make_server(kOtherServerDomain);
    const std::uint32_t jar = show(*second, "jar", 2.0);
    ASSERT_TRUE(
        step_until([&] { return changes[SceneChangeKind::object_comes] == 1; }, second.get()));
    EXPECT_NE(second->epoch(), first);
    EXPECT_EQ(shown_as(last_come().number), (ServerObject{second->epoch(), jar}));
    EXPECT_EQ(keeper->news().went, 2U);
    EXPECT_TRUE(lines.has("scene 'workshop' now follows ")) << lines.text();
}

TEST_F(FollowedScene, passes_over_objects_of_models_that_are_not_here)
{
    show(*server, "cup", 0.0);
    ASSERT_NO_FATAL_FAILURE(start(true, 4, 1));
    show(*server, "pot", 1.0, 1);
    ASSERT_TRUE(step_until([&] { return keeper->news().passed_over == 1; }));
    EXPECT_TRUE(lines.has("object 'pot' can't be touched: its model ")) << lines.text();
    show(*server, "jar", 2.0);
    ASSERT_TRUE(step_until([&] { return changes[SceneChangeKind::object_comes] == 1; }));
    EXPECT_EQ(keeper->news().passed_over, 1U);
    EXPECT_EQ(changes[SceneChangeKind::object_comes], 1);
}

using FollowedModel = SceneKeeperRig;

TEST_F(FollowedModel, goes_where_the_server_s_object_with_the_least_number_is)
{
    const std::uint32_t other = show(*server, "other", 5.0, 1);
    const std::uint32_t cup = show(*server, "cup", 1.0);
    const std::uint32_t pot = show(*server, "pot", 2.0);
    ASSERT_LT(cup, pot);
    ASSERT_NO_FATAL_FAILURE(start(false, 1));
    ASSERT_TRUE(step_until([&] { return shown_as(0).has_value(); }));
    ASSERT_TRUE(step_until([&] { return keeper->counts(0).accepted > 0; }));
    EXPECT_EQ(shown_as(0), (ServerObject{server->epoch(), cup}));
    EXPECT_EQ(keeper->counts(1).accepted, 0U); // None of ours shows it.
    server->objects().remove(other);
    server->objects().remove(cup);
    ASSERT_TRUE(step_until([&] { return shown_as(0) == ServerObject{server->epoch(), pot}; }));
    server->objects().remove(pot);
    ASSERT_TRUE(step_until([&] { return !shown_as(0).has_value(); }));
    EXPECT_EQ(changes[SceneChangeKind::object_goes], 0); // The object stays in place.
    EXPECT_EQ(changes[SceneChangeKind::object_comes], 0);
}

} // namespace
} // namespace tactus::hrtc
