// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/infinity.hpp"
#include "tests/shared/count_of.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/scene_reader.hpp"
#include "transport/dds/wire_values.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include "tactus.h"

namespace tactus::dds
{
namespace
{

using namespace std::chrono_literals;
using test::eventually;
using test::kNan;
using test::make_tiny_model;
using test::TemporaryFolder;

/// Pose with a quarter turn about z.
Pose some_pose(double x_m = 0.25)
{
    return {{0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)}, {x_m, -1.5, 3.0}, 2.0};
}

/// Controller that follows given servers, and keeps the events.
struct Follower
{
    explicit Follower(std::uint32_t domain, const std::string& name = "follower")
        : client_(std::move(DdsClient::create(domain, name, lines.log())).value())
        , scene_(client_->domain(), client_->exchange(), lines.log())
    {
    }

    void step()
    {
        client_->exchange().step();
        scene_.poll(servers,
                    [this](SceneNews what, const SeenObject& object)
                    {
                        ++news[static_cast<std::size_t>(what)];
                        last = object;
                    });
    }
    [[nodiscard]] const SeenObject* find(std::uint64_t server, std::uint32_t object)
    {
        const auto at = scene_.objects(server).find(object);
        return at == scene_.objects(server).end() ? nullptr : &at->second;
    }
    [[nodiscard]] std::size_t count(SceneNews what) const
    {
        return news.at(static_cast<std::size_t>(what));
    }
    [[nodiscard]] DdsClient& client() { return *client_; }
    [[nodiscard]] SceneReader& scene() { return scene_; }

    test::Lines lines;
    std::vector<std::uint64_t> servers;
    std::array<std::size_t, 4> news{};
    SeenObject last;

private:
    std::unique_ptr<DdsClient> client_;
    SceneReader scene_;
};

/// Server of one model and a controller that follows it, in turns, each in its own domain.
struct DdsObjects : ::testing::Test
{
    static constexpr std::uint32_t kServerDomain = 1;
    static constexpr std::uint32_t kOtherServerDomain = 2;
    static constexpr std::uint32_t kClientDomain = 3;

    void SetUp() override
    {
        test::isolate_domains();
        server = make_server(kServerDomain);
        follower.emplace(kClientDomain);
        follower->servers = {server->epoch()};
    }
    std::unique_ptr<DdsServer> make_server(std::uint32_t domain)
    {
        const auto path =
            folder.write(("tiny" + std::to_string(domain)).c_str(), make_tiny_model({}).file);
        std::vector<PublishedModel> models;
        models.push_back({"tiny", ModelStore::open(path).value()});
        auto made = DdsServer::create(domain, std::move(models), {});
        EXPECT_TRUE(made) << made.error().text;
        return std::move(made).value();
    }
    [[nodiscard]] ShownObject object_called(const std::string& name, const Pose& pose = {}) const
    {
        return {name, server->models()[0].store().hash(), {}, pose};
    }
    bool step_until(const std::function<bool()>& is_so)
    {
        return eventually(
            [&]
            {
                server->step();
                follower->step();
                return is_so();
            });
    }
    /// Steps for this time, for events that must not occur, or occur at its end.
    void step_for(std::chrono::milliseconds time)
    {
        const auto end = std::chrono::steady_clock::now() + time;
        static_cast<void>(step_until([&] { return std::chrono::steady_clock::now() > end; }));
        server->step();
        follower->step();
    }
    [[nodiscard]] const SeenObject* seen(std::uint32_t object)
    {
        return follower->find(server->epoch(), object);
    }

    TemporaryFolder folder;
    std::unique_ptr<DdsServer> server;
    std::optional<Follower> follower;
};

TEST_F(DdsObjects, come_move_and_go_as_the_server_says)
{
    ShownObject shown = object_called("cup", some_pose());
    shown.material = {900.0, 0.5, 0.25, 3.0, 4.0, 1e-5, 1e-3};
    const std::uint32_t cup = server->objects().show(shown).value();
    ASSERT_TRUE(step_until([&] { return seen(cup) != nullptr; }));
    EXPECT_TRUE(seen(cup)->shown == shown);
    EXPECT_EQ(follower->count(SceneNews::comes), 1U);

    ASSERT_TRUE(server->objects().move(cup, some_pose(0.5)));
    ASSERT_TRUE(step_until([&] { return seen(cup)->shown.pose.translation_m[0] == 0.5; }));
    EXPECT_GT(seen(cup)->server_time_ns, 0);
    server->objects().remove(cup);
    EXPECT_EQ(server->objects().objects(), 0U);
    ASSERT_TRUE(step_until([&] { return seen(cup) == nullptr; }));
    EXPECT_EQ(follower->count(SceneNews::goes), 1U);

    const std::uint32_t pot = server->objects().show(object_called("pot")).value();
    EXPECT_EQ(pot, cup); // The number is reused with another generation.
    ASSERT_TRUE(step_until([&] { return seen(pot) != nullptr; }));
    EXPECT_EQ(seen(pot)->shown.name, "pot");
    EXPECT_EQ(seen(pot)->generation, 2U);
    EXPECT_EQ(seen(pot)->shown.material.stiffness_n_per_m, kInfinity);
}

TEST_F(DdsObjects, feel_otherwise_when_the_server_says_so)
{
    const std::uint32_t cup = server->objects().show(object_called("cup", some_pose())).value();
    ASSERT_TRUE(step_until([&] { return seen(cup) != nullptr; }));
    EXPECT_EQ(seen(cup)->shown.material, Material{});
    const Material honey{900.0, 0.5, 0.25, 3.0, 4.0, 1e-5, 1e-3};
    ASSERT_TRUE(server->objects().feel(cup, honey));
    ASSERT_TRUE(server->objects().feel(cup, honey)); // The material is unchanged.
    ASSERT_TRUE(step_until([&] { return follower->count(SceneNews::feels) > 0; }));
    EXPECT_EQ(seen(cup)->shown.material, honey);
    EXPECT_EQ(seen(cup)->shown.pose.translation_m, some_pose().translation_m);
    Material none = honey;
    none.texture_height_m = 1e-3; // Height equal to the length.
    const auto refused = server->objects().feel(cup, none);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text.find("object 'cup' has an invalid material"), 0U);
    EXPECT_EQ(server->objects().find(cup)->material, honey);
    step_for(100ms);
    EXPECT_EQ(follower->count(SceneNews::feels), 1U);
    EXPECT_EQ(follower->count(SceneNews::comes), 1U);
    // A late joiner gets the present material.
    follower.emplace(kClientDomain, "late");
    follower->servers = {server->epoch()};
    ASSERT_TRUE(step_until([&] { return seen(cup) != nullptr; }));
    EXPECT_EQ(seen(cup)->shown.material, honey);
    EXPECT_EQ(follower->count(SceneNews::feels), 0U);
}

TEST_F(DdsObjects, are_heard_of_at_rest_as_often_as_in_motion)
{
    const std::uint32_t cup = server->objects().show(object_called("cup")).value();
    ASSERT_TRUE(
        step_until([&] { return seen(cup) && follower->scene().was_heard(server->epoch()); }));
    // A beat is sent every 20 ms. Records, once a second, would be too few.
    int heard = 0;
    EXPECT_TRUE(eventually(
        [&]
        {
            server->wait(50ms);
            server->step();
            follower->step();
            heard += follower->scene().was_heard(server->epoch()) ? 1 : 0;
            return heard == 100;
        }))
        << heard;
    EXPECT_EQ(follower->count(SceneNews::moves), 0U);
}

/// A late joiner gets the record, which includes objects that have rested for long.
TEST_F(DdsObjects, stand_for_a_late_joiner_where_they_came_to_rest)
{
    const std::uint32_t cup = server->objects().show(object_called("cup")).value();
    for (int i = 1; i <= 20; ++i)
    {
        ASSERT_TRUE(server->objects().move(cup, some_pose(0.01 * i)));
        server->step();
    }
    step_for(700ms);
    follower.emplace(kClientDomain, "late");
    follower->servers = {server->epoch()};
    ASSERT_TRUE(step_until([&] { return seen(cup) != nullptr; }));
    EXPECT_NEAR(seen(cup)->shown.pose.translation_m[0], 0.2, 1e-15);
    EXPECT_EQ(follower->count(SceneNews::moves), 0U);
}

TEST_F(DdsObjects, many_come_at_once_and_move_together)
{
    constexpr std::uint32_t kMany = 1'000;
    for (std::uint32_t i = 0; i < kMany; ++i)
    {
        ASSERT_TRUE(server->objects().show(object_called("o" + std::to_string(i))));
    }
    ASSERT_TRUE(step_until([&] { return follower->scene().is_complete(server->epoch()); }));
    EXPECT_EQ(follower->scene().objects(server->epoch()).size(), kMany);
    for (std::uint32_t i = 0; i < kMany; ++i)
    {
        ASSERT_TRUE(server->objects().move(i, some_pose(1e-3 * i)));
    }
    EXPECT_TRUE(step_until(
        [&]
        {
            bool all = true;
            for (std::uint32_t i = 0; i < kMany && all; ++i)
            {
                all = seen(i)->shown.pose.translation_m[0] == 1e-3 * i &&
                      seen(i)->shown.pose.scale == 2.0;
            }
            return all;
        }));
}

TEST_F(DdsObjects, that_a_server_must_not_show_never_leave_it)
{
    ObjectPublisher& sut = server->objects();
    const auto refused =
        [&](const std::string& words, const std::function<void(ShownObject&)>& spoil)
    {
        ShownObject object = object_called("cup");
        spoil(object);
        const auto number = sut.show(object);
        EXPECT_FALSE(number) << words;
        EXPECT_NE(number.error().text.find(words), std::string::npos) << number.error().text;
    };
    refused("object 'two words' needs a name",
            [](ShownObject& object) { object.name = "two words"; });
    refused("which isn't served", [](ShownObject& object) { object.model[0] ^= 1U; });
    refused("object 'cup' has an invalid pose: not_finite",
            [](ShownObject& object) { object.pose.scale = kNan; });
    refused("has an invalid material",
            [](ShownObject& object) { object.material.dynamic_friction = 0.5; });
    refused("has an invalid material",
            [](ShownObject& object) {
                object.material = {0.0, 0.0, 0.0, 0.0};
            });
    for (std::uint32_t i = 0; i < kMaxObjects; ++i)
    {
        ASSERT_TRUE(sut.show(object_called("cup")));
    }
    refused("is refused: at most 4096 objects are served", [](ShownObject&) {});
    sut.remove(17);
    EXPECT_EQ(sut.show(object_called("cup")).value(), 17U);
    Pose pose = some_pose();
    pose.rotation[0] = 1.0;
    EXPECT_EQ(sut.move(0, pose).error(), PoseRefusal::rotation);
    EXPECT_TRUE(sut.move(0, some_pose()));
    EXPECT_EQ(sut.find(kMaxObjects), nullptr);
}

/// Samples of the server's own participant that its program did not send.
struct DdsObjectFaults : DdsObjects
{
    void SetUp() override
    {
        DdsObjects::SetUp();
        cup_ = server->objects().show(object_called("cup")).value();
        ASSERT_TRUE(step_until([&] { return seen(cup_) != nullptr; }));
        motion_ =
            make_writer(server->domain(), Topic::motion, server_partition(server->epoch())).value();
        ASSERT_TRUE(eventually([&] { return is_matched(motion_); }));
    }
    void write(std::uint64_t serial, const tactus_v5_MovedObject& moved)
    {
        tactus_v5_MovedObject copy = moved;
        tactus_v5_Motion sample = {};
        sample.server_epoch = server->epoch();
        sample.serial = serial;
        sample.server_time_ns = 1;
        sample.moved = {1, 1, &copy, false};
        EXPECT_EQ(dds_write(motion_.handle, &sample), DDS_RETCODE_OK);
    }
    [[nodiscard]] tactus_v5_MovedObject good(double x_m = 0.0) const
    {
        return {cup_, 1, to_wire(some_pose(x_m))};
    }
    /// Writes until the sample was counted, since best effort guarantees nothing.
    void write_until_counted(std::uint64_t serial, const tactus_v5_MovedObject& moved)
    {
        const auto counted = [&]
        { return seen(cup_)->counts.accepted + seen(cup_)->counts.refused_in_all(); };
        const std::uint64_t before = counted();
        EXPECT_TRUE(eventually(
            [&]
            {
                write(serial, moved);
                for (int i = 0; i < 50 && counted() == before; ++i)
                {
                    follower->step();
                    std::this_thread::sleep_for(1ms);
                }
                return counted() > before;
            }));
    }
    [[nodiscard]] std::uint64_t refused(PoseRefusal refusal)
    {
        return seen(cup_)->counts.refused.at(static_cast<std::size_t>(refusal));
    }

    std::uint32_t cup_{0};
    Endpoint motion_;
};

TEST_F(DdsObjectFaults, are_refused_under_their_names_and_change_nothing)
{
    struct Fault
    {
        PoseRefusal refusal;
        std::function<void(tactus_v5_Placement&)> make;
    };
    using Place = tactus_v5_Placement;
    const std::vector<Fault> faults{
        {PoseRefusal::not_finite, [](Place& p) { p.rotation[0] = kNan; }},
        {PoseRefusal::not_finite, [](Place& p) { p.rotation[3] = kInfinity; }},
        {PoseRefusal::not_finite, [](Place& p) { p.translation_m[1] = -kInfinity; }},
        {PoseRefusal::not_finite, [](Place& p) { p.scale = kNan; }},
        {PoseRefusal::rotation, [](Place& p) { p.rotation[3] = 0.0; }},
        {PoseRefusal::rotation, [](Place& p) { p.rotation[0] = 1e300; }},
        {PoseRefusal::translation, [](Place& p) { p.translation_m[0] = 10'000.1; }},
        {PoseRefusal::translation, [](Place& p) { p.translation_m[2] = -10'000.1; }},
        {PoseRefusal::scale, [](Place& p) { p.scale = 0.0; }},
        {PoseRefusal::scale, [](Place& p) { p.scale = -1.0; }},
        {PoseRefusal::scale, [](Place& p) { p.scale = 1'000.1; }},
    };
    write_until_counted(1'000, good(0.5));
    for (std::size_t i = 0; i < faults.size(); ++i)
    {
        tactus_v5_MovedObject moved = good(0.75);
        faults[i].make(moved.pose);
        const std::uint64_t before = refused(faults[i].refusal);
        write_until_counted(2'000 + i, moved);
        EXPECT_GT(refused(faults[i].refusal), before) << i;
        EXPECT_EQ(seen(cup_)->shown.pose.translation_m[0], 0.5) << i;
    }
    write_until_counted(999, good(0.75)); // Late.
    EXPECT_GE(refused(PoseRefusal::not_newer), 1U);
    EXPECT_EQ(seen(cup_)->shown.pose.translation_m[0], 0.5);
    write_until_counted(1'001, good(0.75)); // Refused samples leave no trace.
    EXPECT_EQ(seen(cup_)->shown.pose.translation_m[0], 0.75);
}

TEST_F(DdsObjectFaults, of_objects_that_are_not_there_or_were_are_passed_over)
{
    tactus_v5_MovedObject moved = good(0.5);
    moved.object = cup_ + 1;
    write(1'000, moved);
    moved = good(0.5);
    moved.generation = 7;
    write(1'001, moved);
    write_until_counted(1'002, good(0.25));
    EXPECT_EQ(follower->scene().objects(server->epoch()).size(), 1U);
    EXPECT_EQ(seen(cup_)->shown.pose.translation_m[0], 0.25);
    EXPECT_EQ(seen(cup_)->counts.refused_in_all(), 0U);
}

/// Any content of a sample: only a pose passes.
TEST_F(DdsObjectFaults, of_noise_never_pass_for_a_pose)
{
    constexpr std::uint64_t kSeed = 20'261'122;
    std::mt19937_64 random(kSeed);
    for (std::uint64_t i = 0; i < 5'000; ++i)
    {
        tactus_v5_MovedObject moved = good();
        for (double* number :
             {&moved.pose.rotation[0], &moved.pose.rotation[1], &moved.pose.rotation[2],
              &moved.pose.rotation[3], &moved.pose.translation_m[0], &moved.pose.scale})
        {
            const std::uint64_t bits = random();
            std::memcpy(number, &bits, sizeof(bits));
        }
        write(1'000 + i, moved);
        follower->step();
        EXPECT_TRUE(checked_pose(seen(cup_)->shown.pose)) << "seed " << kSeed;
    }
    EXPECT_TRUE(eventually(
        [&]
        {
            write(1'000'000, good(0.125));
            follower->step();
            return seen(cup_)->shown.pose.translation_m[0] == 0.125;
        }));
    EXPECT_GT(seen(cup_)->counts.refused_in_all(), 0U);
}

/// Messages of a server's participant about objects and models that its program does not allow.
struct DdsServerFaults : DdsObjectFaults
{
    void SetUp() override
    {
        DdsObjectFaults::SetUp();
        records_ = make_writer(server->domain(), Topic::objects, server_partition(server->epoch()))
                       .value();
        entries_ = make_writer(server->domain(), Topic::catalogue, "").value();
        ASSERT_TRUE(eventually([&] { return is_matched(records_) && is_matched(entries_); }));
    }
    [[nodiscard]] tactus_v5_ObjectRecord record_of(std::uint32_t number, const std::string& name,
                                                   const ContentHash& model)
    {
        tactus_v5_ObjectRecord record = {};
        record.server_epoch = server->epoch();
        record.object = number;
        record.generation = 1;
        name.copy(static_cast<char*>(record.name), kMaxNameBytes);
        std::memcpy(record.model_hash, model.data(), model.size());
        record.serial = 1'000;
        record.pose = to_wire(some_pose());
        return record;
    }
    void show(std::uint32_t number, const std::string& name, const ContentHash& model)
    {
        const tactus_v5_ObjectRecord record = record_of(number, name, model);
        EXPECT_EQ(dds_write(records_.handle, &record), DDS_RETCODE_OK);
    }
    void announce(std::uint32_t number, const std::string& name, const ContentHash& model)
    {
        tactus_v5_CatalogueEntry entry = {};
        entry.server_epoch = server->epoch();
        entry.model = number;
        name.copy(static_cast<char*>(entry.name), kMaxNameBytes);
        std::memcpy(entry.model_hash, model.data(), model.size());
        entry.faces = 8;
        entry.header_bytes = entry.base_bytes = 100;
        EXPECT_EQ(dds_write(entries_.handle, &entry), DDS_RETCODE_OK);
    }
    [[nodiscard]] ContentHash other_model() const
    {
        ContentHash hash = server->models()[0].store().hash();
        hash[0] ^= 1U;
        return hash;
    }
    [[nodiscard]] std::uint64_t refused_of_server(Refused reason)
    {
        const ParticipantId own = server->domain().participants().own();
        std::uint64_t count = 0;
        for (const PeerRefusals& peer :
             follower->client().domain().participants().refusals().list())
        {
            EXPECT_EQ(peer.id, own);
            count += peer.counts.at(static_cast<std::size_t>(reason));
        }
        return count;
    }
    [[nodiscard]] std::size_t lines_with(const std::string& part)
    {
        return test::count_of(follower->lines.text(), part);
    }

    Endpoint records_;
    Endpoint entries_;
};

/// A controller keeps 4,096 objects and 256 models of one server.
TEST_F(DdsServerFaults, more_objects_and_models_than_a_controller_holds_take_no_room)
{
    const ContentHash model = server->models()[0].store().hash();
    for (const std::uint32_t number :
         {std::uint32_t{kMaxObjects}, std::uint32_t{kMaxObjects} + 1, 100'000U, UINT32_MAX})
    {
        show(number, "beyond", model);
        announce(number, "beyond", other_model());
    }
    announce(kMaxModels, "beyond", other_model());
    show(kMaxObjects - 1, "last", model); // The writer keeps its order: it comes after them.
    announce(kMaxModels - 1, "last", other_model());
    const auto is_offered = [&](const char* name) {
        return follower->client().catalogue().find({name, std::nullopt}) != nullptr;
    };
    ASSERT_TRUE(step_until([&] { return seen(kMaxObjects - 1) && is_offered("last"); }));
    EXPECT_EQ(follower->scene().objects(server->epoch()).size(), 2U);
    EXPECT_FALSE(is_offered("beyond"));
    EXPECT_EQ(seen(cup_)->shown.name, "cup");
    EXPECT_EQ(refused_of_server(Refused::object_number), 4U);
    EXPECT_EQ(refused_of_server(Refused::model_number), 5U);
    const std::string who = "(process " + std::to_string(::getpid()) + " on ";
    follower->step(); // Includes counts between its poll and the last take.
    EXPECT_TRUE(follower->lines.has(who)) << follower->lines.text();
    EXPECT_EQ(lines_with("object 4096: its number is not in 0 .. 4095"), 1U);
    EXPECT_EQ(lines_with("model 4096: its number is not in 0 .. 255"), 1U);
}

/// Invalid records: counted by reason, and named once.
TEST_F(DdsServerFaults, records_that_are_none_are_named_once_and_change_nothing)
{
    const auto write =
        [&](std::uint32_t number, const std::function<void(tactus_v5_ObjectRecord&)>& spoil)
    {
        tactus_v5_ObjectRecord record =
            record_of(number, "pot", server->models()[0].store().hash());
        spoil(record);
        EXPECT_EQ(dds_write(records_.handle, &record), DDS_RETCODE_OK);
    };
    for (std::uint32_t i = 1; i < 4; ++i)
    {
        write(10 + i, [](auto& record) { std::strcpy(static_cast<char*>(record.name), "a b"); });
    }
    write(20, [](auto& record) { record.stiffness_n_per_m = -1.0; });
    write(21, [](auto& record) { record.dynamic_friction = kNan; });
    write(30, [](auto& record) { record.pose.translation_m[0] = kNan; });
    announce(1, "a/b", other_model());
    show(40, "last", server->models()[0].store().hash());
    ASSERT_TRUE(step_until(
        [&] { return seen(40) != nullptr && refused_of_server(Refused::model_name) == 1; }));
    EXPECT_EQ(refused_of_server(Refused::object_name), 3U);
    EXPECT_EQ(refused_of_server(Refused::object_material), 2U);
    EXPECT_EQ(refused_of_server(Refused::object_pose), 1U);
    EXPECT_EQ(follower->scene().objects(server->epoch()).size(), 2U);
    follower->step();
    EXPECT_EQ(lines_with("object 11: its name is not"), 1U) << follower->lines.text();
    EXPECT_EQ(lines_with("refused from "), 4U) << follower->lines.text();
}

TEST_F(DdsServerFaults, objects_of_models_that_it_does_not_serve_are_refused_by_name)
{
    show(7, "ghost", other_model());
    show(8, "cup-2", server->models()[0].store().hash());
    ASSERT_TRUE(step_until([&] { return seen(8) != nullptr; }));
    EXPECT_EQ(seen(7), nullptr);
    const std::string line = "object 'ghost' is refused: its server doesn't serve its model, " +
                             hash_text(other_model()) + "\n";
    ASSERT_TRUE(step_until([&] { return follower->lines.has(line); }));
    show(7, "ghost", other_model()); // Repeated by a server after a rest: no second line.
    step_for(2'500ms);
    EXPECT_EQ(seen(7), nullptr);
    EXPECT_EQ(lines_with("is refused"), 1U);
    EXPECT_EQ(follower->count(SceneNews::comes), 2U);
    EXPECT_EQ(follower->count(SceneNews::goes), 0U);
    // The object appears once the model is served; one that is removed before is never reported.
    show(9, "wraith", other_model());
    tactus_v5_ObjectRecord gone = {};
    gone.server_epoch = server->epoch();
    gone.object = 9;
    EXPECT_EQ(dds_dispose(records_.handle, &gone), DDS_RETCODE_OK);
    step_for(500ms); // Waits until the server's statement about its objects settles it.
    announce(1, "ghosts", other_model());
    ASSERT_TRUE(step_until([&] { return seen(7) != nullptr; }));
    EXPECT_EQ(seen(7)->shown.name, "ghost");
    EXPECT_EQ(seen(9), nullptr);
    EXPECT_EQ(follower->count(SceneNews::comes), 3U);
}

TEST_F(DdsServerFaults, a_model_that_changes_under_its_name_changes_nothing_that_is_there)
{
    auto found = follower->client().find({"tiny", std::nullopt}, test::kPatience,
                                         [&]
                                         {
                                             server->step();
                                             return true;
                                         });
    ASSERT_TRUE(found) << found.error().text;
    ChunkLink& link = *found.value().link;
    const ContentHash model = found.value().hash;
    class Nobody final : public PieceSink
    {
        void receive(ContentKey /*key*/, std::span<const std::byte> /*bytes*/) override {}
    } nobody;
    announce(0, "tiny", other_model());
    const auto told = [&](const std::string& part)
    {
        return step_until(
            [&]
            {
                link.poll(nobody);
                return follower->lines.has(part);
            });
    };
    EXPECT_TRUE(told("model 'tiny' is now published with another hash, " +
                     hash_text(other_model()) + "; the resident data are kept"));
    EXPECT_EQ(seen(cup_)->shown.model, model);
    EXPECT_EQ(follower->count(SceneNews::goes), 0U);
    // The server repeats the truth within a second.
    EXPECT_TRUE(told("model 'tiny' is served again"));
    EXPECT_EQ(link.state(), LinkState::connected);
}

/// A stranger in the server's partition overwrites, moves and removes its object.
TEST_F(DdsObjectFaults, of_who_is_not_the_server_do_not_get_in)
{
    const Domain stranger = Domain::join(kOtherServerDomain).value();
    const std::string partition = server_partition(server->epoch());
    const Endpoint records = make_writer(stranger, Topic::objects, partition).value();
    const Endpoint motion = make_writer(stranger, Topic::motion, partition).value();
    ASSERT_TRUE(eventually([&] { return is_matched(records) && is_matched(motion); }));
    tactus_v5_ObjectRecord record = {};
    record.server_epoch = server->epoch();
    record.object = cup_;
    record.generation = 9;
    record.serial = 1'000'000;
    std::strcpy(static_cast<char*>(record.name), "false");
    record.pose = to_wire(some_pose(7.0));
    ASSERT_EQ(dds_write(records.handle, &record), DDS_RETCODE_OK);
    record.object = cup_ + 1;
    ASSERT_EQ(dds_write(records.handle, &record), DDS_RETCODE_OK);
    record.object = cup_;
    ASSERT_EQ(dds_dispose(records.handle, &record), DDS_RETCODE_OK);
    tactus_v5_MovedObject moved = good(7.0);
    tactus_v5_Motion sample = {};
    sample.server_epoch = server->epoch();
    sample.serial = 1'000'000;
    sample.moved = {1, 1, &moved, false};
    ASSERT_EQ(dds_write(motion.handle, &sample), DDS_RETCODE_OK);
    step_for(300ms);
    ASSERT_NE(seen(cup_), nullptr);
    EXPECT_EQ(seen(cup_)->shown.name, "cup");
    EXPECT_EQ(seen(cup_)->shown.pose.translation_m[0], 0.0);
    EXPECT_EQ(follower->scene().objects(server->epoch()).size(), 1U);
    const auto refused = follower->client().domain().participants().refusals().list();
    ASSERT_EQ(refused.size(), 1U);
    EXPECT_EQ(refused[0].id, stranger.participants().own());
    // Both records; motion may get lost.
    EXPECT_GE(refused[0].counts.at(static_cast<std::size_t>(Refused::identity)), 2U);
    write_until_counted(2'000, good(0.5)); // The server itself continues as before.
    EXPECT_EQ(seen(cup_)->shown.pose.translation_m[0], 0.5);
}

TEST_F(DdsObjects, of_a_server_that_is_not_followed_any_more_go)
{
    static_cast<void>(server->objects().show(object_called("cup")).value());
    ASSERT_TRUE(step_until([&] { return follower->count(SceneNews::comes) == 1; }));
    follower->servers.clear();
    follower->step();
    EXPECT_EQ(follower->count(SceneNews::goes), 1U);
    EXPECT_TRUE(follower->scene().objects(server->epoch()).empty());
}

TEST_F(DdsObjects, of_two_servers_are_told_apart)
{
    const auto other = make_server(kOtherServerDomain);
    follower->servers.push_back(other->epoch());
    const std::uint32_t cup = server->objects().show(object_called("cup", some_pose(1.0))).value();
    const std::uint32_t pot = other->objects().show(object_called("pot", some_pose(2.0))).value();
    EXPECT_EQ(cup, pot);
    EXPECT_TRUE(step_until(
        [&]
        {
            other->step();
            return seen(cup) != nullptr && follower->find(other->epoch(), pot) != nullptr;
        }));
    EXPECT_EQ(seen(cup)->shown.name, "cup");
    EXPECT_EQ(follower->find(other->epoch(), pot)->shown.name, "pot");
}

/// Eight together: two get everything at once, the others after these.
TEST_F(DdsObjects, come_to_many_controllers_a_few_at_a_time)
{
    constexpr std::uint32_t kMany = 500;
    for (std::uint32_t i = 0; i < kMany; ++i)
    {
        ASSERT_TRUE(server->objects().show(object_called("o" + std::to_string(i))));
    }
    std::vector<std::unique_ptr<Follower>> crowd;
    for (int i = 0; i < 8; ++i)
    {
        crowd.push_back(std::make_unique<Follower>(kClientDomain, "c" + std::to_string(i)));
        crowd.back()->servers = {server->epoch()};
    }
    std::ptrdiff_t joining_max = 0;
    const auto has_all = [&](const std::unique_ptr<Follower>& each)
    { return each->scene().objects(server->epoch()).size() == kMany; };
    EXPECT_TRUE(eventually(
        [&]
        {
            server->step();
            std::ptrdiff_t joining = 0;
            for (const auto& each : crowd)
            {
                each->step();
                joining += each->client().exchange().is_admitted(server->epoch()) &&
                                   !each->scene().is_complete(server->epoch())
                               ? 1
                               : 0;
            }
            joining_max = std::max(joining_max, joining);
            return std::ranges::all_of(crowd, has_all);
        }));
    EXPECT_LE(joining_max, 2);
}

TEST_F(DdsObjects, motion_that_is_not_heard_comes_by_another_writer)
{
    const auto number = server->objects().show(object_called("a", some_pose()));
    ASSERT_TRUE(number);
    ASSERT_TRUE(step_until([&] { return follower->scene().was_heard(server->epoch()); }));
    ASSERT_TRUE(step_until([&] { return follower->scene().is_complete(server->epoch()); }));
    EXPECT_EQ(server->counters().renewed, 0U);
    // The scene's reader reports this after 300 ms of silence.
    ASSERT_TRUE(step_until(
        [&]
        {
            follower->client().exchange().report_objects_received(server->epoch(), false);
            follower->client().exchange().step();
            return server->counters().renewed > 0;
        }));
    EXPECT_FALSE(server->objects().try_renew_motion(std::chrono::steady_clock::now()));
    step_for(500ms); // The first writer is gone by then.
    ASSERT_TRUE(server->objects().move(number.value(), some_pose(0.5)));
    EXPECT_TRUE(step_until(
        [&]
        {
            const SeenObject* object = seen(number.value());
            return object != nullptr && object->shown.pose.translation_m[0] == 0.5;
        }));
    EXPECT_EQ(server->counters().renewed, 1U);
}

} // namespace
} // namespace tactus::dds
