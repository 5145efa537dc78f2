// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/random.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/random_edits.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/edit_reader.hpp"
#include "transport/edit_content.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tactus.h"

namespace tactus::dds
{
namespace
{

using test::eventually;
using test::kNan;
using test::make_tiny_model;
using test::Random;
using test::RandomEdits;
using test::TemporaryFolder;

constexpr std::uint32_t kEditRoom = 500;

/// Controller that reads the edits of one model, and the surface that its frame would have.
struct Controller
{
    Controller(std::uint32_t domain, const test::TinyModel& model, std::uint32_t room = kEditRoom)
        : client_(std::move(DdsClient::create(domain, "controller", lines.log())).value())
        , header_(ModelHeader::parse(model.header).value())
        , reader(client_->domain(), client_->catalogue(),
                 {{"tiny", model_hash(model.header), header_, room}}, lines.log())
        , writer(client_->domain())
        , frame(header_.counts(), room)
    {
    }

    /// Takes news, and passes each edit to the "frame", which checks it.
    void step()
    {
        client_->catalogue().refresh();
        reader.poll();
        while (const EditContent* edit = reader.next(0))
        {
            const auto fault = frame.fault_of(*edit);
            ASSERT_FALSE(fault) << fault->text;
            frame.apply(*edit);
            reader.pop(0);
        }
    }
    /// The offer of this server, once it is known.
    [[nodiscard]] const Catalogue::Offer* offer(const DdsServer& server)
    {
        const auto offers = client_->catalogue().offers_of(server.epoch());
        return offers.empty() ? nullptr : offers.front();
    }
    [[nodiscard]] const Domain& domain() const { return client_->domain(); }
    test::Lines lines;

private:
    std::unique_ptr<DdsClient> client_;
    ModelHeader header_;

public:
    EditReader reader;
    EditWriter writer;
    EditState frame;
};

/// Server of one model that can be edited, and controllers, in turns, each in its own domain.
struct DdsEdits : ::testing::Test
{
    void SetUp() override
    {
        test::isolate_domains();
        server = make_server(1);
    }
    std::unique_ptr<DdsServer> make_server(std::uint32_t domain, Editors editors = {true, {}},
                                           std::uint32_t room = kEditRoom)
    {
        const auto path = folder.write(("tiny" + std::to_string(domain)).c_str(), model.file);
        std::vector<PublishedModel> models;
        models.push_back({"tiny", ModelStore::open(path).value(), room});
        return std::move(DdsServer::create(domain, std::move(models), lines.log(), {},
                                           Party::server, std::move(editors)))
            .value();
    }
    /// Publishes random edits, with the server's sums.
    void publish(DdsServer& by, std::uint32_t count)
    {
        for (std::uint32_t i = 0; i < count; ++i)
        {
            const std::vector<EditContent> edits{edits_.next(random_)};
            const auto fault = by.edits()->publish(0, edits);
            ASSERT_FALSE(fault) << fault->text;
        }
    }
    bool both_until(Controller& controller, const std::function<bool()>& is_so)
    {
        return eventually(
            [&]
            {
                server->step();
                if (other != nullptr)
                {
                    other->step();
                }
                controller.step();
                return is_so();
            });
    }
    /// Steps until the controller has the surface of the server.
    testing::AssertionResult agrees(Controller& controller, DdsServer& with)
    {
        const bool does = both_until(
            controller, [&] { return controller.frame.is_same_surface(*with.edits()->state(0)); });
        return does ? testing::AssertionSuccess()
                    : testing::AssertionFailure() << controller.lines.text();
    }

    test::TinyModel model = make_tiny_model({.records = 2'000});
    TemporaryFolder folder;
    test::Lines lines;
    std::unique_ptr<DdsServer> server;
    std::unique_ptr<DdsServer> other;
    ModelHeader header_ = ModelHeader::parse(model.header).value();
    Random random_{11};
    RandomEdits edits_{header_, kEditRoom};
};

TEST_F(DdsEdits, each_edit_arrives_and_the_catalogue_says_the_room)
{
    Controller sut(2, model);
    sut.reader.follow(0, server->epoch());
    ASSERT_TRUE(both_until(sut, [&] { return sut.offer(*server) != nullptr; }));
    EXPECT_EQ(sut.offer(*server)->edit_room, kEditRoom);
    for (int i = 0; i < 20; ++i)
    {
        publish(*server, 3);
        ASSERT_TRUE(agrees(sut, *server));
    }
    EXPECT_EQ(sut.frame.revision(), sut.reader.counts(0).edits);
    EXPECT_EQ(sut.reader.counts(0).refused, 0U);
    EXPECT_EQ(server->edits()->counters().edits, 60U);
}

TEST_F(DdsEdits, a_late_controller_gets_the_sum_and_the_edits_behind_it)
{
    publish(*server, 2 * kKeptEdits + 40);
    Controller sut(2, model);
    sut.reader.follow(0, server->epoch());
    ASSERT_TRUE(agrees(sut, *server));
    EXPECT_GE(sut.reader.counts(0).sums, 1U);
    publish(*server, 5);
    ASSERT_TRUE(agrees(sut, *server));
}

TEST_F(DdsEdits, a_controller_that_missed_edits_goes_on_with_the_sum)
{
    Controller sut(2, model);
    sut.reader.follow(0, server->epoch());
    publish(*server, 10);
    ASSERT_TRUE(agrees(sut, *server));
    publish(*server, kKeptEdits + 30); // Not read meanwhile: the first of them are overwritten.
    ASSERT_TRUE(agrees(sut, *server));
    EXPECT_EQ(sut.reader.counts(0).refused, 0U);
}

TEST_F(DdsEdits, what_cannot_follow_is_refused_and_not_published)
{
    EXPECT_TRUE(server->edits()->publish(7, {}));
    EditContent edit = edits_.next(random_);
    edit.revision = 2;
    ASSERT_TRUE(server->edits()->publish(0, std::vector{edit}));
    EXPECT_EQ(server->edits()->counters().edits, 0U);
    EXPECT_EQ(server->edits()->state(0)->revision(), 0U);
    EXPECT_FALSE(DdsServer::create(3, {}, {}).value()->edits());
}

/// Writes samples of edits in the name of any server.
struct Forger
{
    Forger(const Domain& domain, const DdsServer& of, const ModelHeader& header)
        : header_(header)
        , epoch_(of.epoch())
        , writer_(std::move(make_writer(domain, Topic::edits, server_partition(epoch_))).value())
    {
    }

    void write(const EditContent& edit, std::uint32_t index, std::uint32_t from, std::uint32_t to,
               std::uint32_t part = 0, std::uint32_t parts = 1, std::size_t cut = 0)
    {
        std::vector<std::byte> coded;
        encode_edit(edit, header_, coded);
        coded.resize(coded.size() - cut);
        tactus_v5_Edits sample = {};
        sample.server_epoch = epoch_;
        sample.index = index;
        sample.from = from;
        sample.to = to;
        sample.part = part;
        sample.parts = parts;
        const auto bytes = static_cast<std::uint32_t>(coded.size());
        sample.payload = {bytes, bytes, reinterpret_cast<std::uint8_t*>(coded.data()), false};
        dds_write(writer_.handle, &sample);
    }
    [[nodiscard]] bool is_matched() const { return dds::is_matched(writer_); }

private:
    ModelHeader header_;
    std::uint64_t epoch_;
    Endpoint writer_;
};

/// Refused samples with this reason, of all participants.
std::uint64_t refused(const Domain& domain, Refused reason)
{
    std::uint64_t count = 0;
    for (const PeerRefusals& peer : domain.participants().refusals().list())
    {
        count += peer.counts.at(static_cast<std::size_t>(reason));
    }
    return count;
}

TEST_F(DdsEdits, lost_doubled_and_forged_samples_of_the_server_leave_the_surface_right)
{
    Controller sut(2, model);
    sut.reader.follow(0, server->epoch());
    ASSERT_TRUE(agrees(sut, *server));
    // A second writer of the same participant is as true as the first.
    Forger forger(server->domain(), *server, header_);
    ASSERT_TRUE(both_until(sut, [&] { return forger.is_matched(); }));
    const EditContent first = edits_.next(random_);
    const EditContent second = edits_.next(random_);
    const EditContent third = edits_.next(random_);
    EditState wanted(header_.counts(), kEditRoom);
    const auto revision_is = [&](std::uint32_t revision)
    { return both_until(sut, [&] { return sut.frame.revision() == revision; }); };
    forger.write(first, 1, 0, 1);
    ASSERT_TRUE(revision_is(1));
    forger.write(first, 1, 0, 1); // Doubled.
    forger.write(third, 3, 2, 3); // The one before it is late.
    ASSERT_TRUE(both_until(sut, [&] { return sut.reader.counts(0).gaps == 1; }));
    EXPECT_EQ(sut.frame.revision(), 1U);
    forger.write(second, 2, 1, 2, 0, 1, 1); // Damaged.
    ASSERT_TRUE(both_until(sut, [&] { return sut.reader.counts(0).refused == 1; }));
    EXPECT_TRUE(sut.lines.has("model 'tiny': an edit is refused"));
    forger.write(second, 2, 1, 2);
    ASSERT_TRUE(revision_is(3));
    for (const EditContent& edit : {first, second, third})
    {
        wanted.apply(edit);
    }
    EXPECT_TRUE(sut.frame.is_same_surface(wanted));
    // Numbers that do not fit together never reach the reader.
    const std::uint64_t before = refused(sut.domain(), Refused::edit);
    forger.write(edits_.next(random_), 5, 3, 4);                // Index of another edit.
    forger.write(first, 4, 2, 4);                               // Two at once.
    forger.write(first, kKeptEdits, 0, 9, 0, 0);                // No parts.
    forger.write(first, kKeptEdits + 1, 0, 9, 1, 1);            // A part beyond them.
    forger.write(first, kKeptEdits, 0, 9, 0, kMaxSumParts + 1); // Too many.
    forger.write(first, kKeptEdits + 1, 0, 9, 0, 2);            // Index of another part.
    forger.write(first, kKeptEdits, 0, 9, 0, kMaxSumParts);     // More than faces.
    ASSERT_TRUE(
        both_until(sut, [&] { return refused(sut.domain(), Refused::edit) == before + 7; }));
    EXPECT_EQ(sut.frame.revision(), 3U);
    EXPECT_FALSE(sut.reader.counts(0).is_stopped);
}

TEST_F(DdsEdits, another_participant_cannot_edit_in_the_name_of_the_server)
{
    Controller sut(2, model);
    sut.reader.follow(0, server->epoch());
    ASSERT_TRUE(agrees(sut, *server));
    const auto stranger = std::move(Domain::join(DomainChoice(3))).value();
    Forger forger(stranger, *server, header_);
    ASSERT_TRUE(both_until(sut, [&] { return forger.is_matched(); }));
    forger.write(edits_.next(random_), 1, 0, 1);
    ASSERT_TRUE(both_until(sut, [&] { return refused(sut.domain(), Refused::identity) == 1; }));
    EXPECT_EQ(sut.frame.revision(), 0U);
}

TEST_F(DdsEdits, a_new_server_is_followed_if_its_edits_lead_on)
{
    Controller sut(2, model);
    sut.reader.follow(0, server->epoch());
    RandomEdits same(header_, kEditRoom);
    Random seed(12);
    std::vector<EditContent> history;
    for (int i = 0; i < 30; ++i)
    {
        history.push_back(same.next(seed));
    }
    ASSERT_FALSE(server->edits()->publish(0, std::span(history).first(20)));
    ASSERT_TRUE(agrees(sut, *server));
    other = make_server(3);
    ASSERT_FALSE(other->edits()->publish(0, history));
    sut.reader.follow(0, other->epoch());
    ASSERT_TRUE(agrees(sut, *other));
    EXPECT_FALSE(sut.reader.counts(0).is_stopped);
}

TEST_F(DdsEdits, a_server_that_lost_its_edits_stops_them)
{
    Controller sut(2, model);
    sut.reader.follow(0, server->epoch());
    publish(*server, 4);
    ASSERT_TRUE(agrees(sut, *server));
    const std::uint32_t revision = sut.frame.revision();
    other = make_server(3);
    sut.reader.follow(0, other->epoch());
    ASSERT_TRUE(both_until(sut, [&] { return sut.reader.counts(0).is_stopped; }));
    EXPECT_TRUE(sut.lines.has("model 'tiny': its server has lost its edits"));
    EXPECT_EQ(sut.frame.revision(), revision);
}

TEST_F(DdsEdits, a_room_that_is_too_small_stops_them_by_name)
{
    Controller sut(2, model, 1);
    sut.reader.follow(0, server->epoch());
    publish(*server, kKeptEdits + 1); // The sum follows at once.
    ASSERT_TRUE(both_until(sut, [&] { return sut.reader.counts(0).is_stopped; }));
    EXPECT_TRUE(sut.lines.has("the room is 1 (--edit-faces)"));
}

TEST_F(DdsEdits, a_model_whose_edit_a_frame_refused_gets_no_more)
{
    Controller sut(2, model);
    Controller witness(3, model);
    sut.reader.follow(0, server->epoch());
    witness.reader.follow(0, server->epoch());
    publish(*server, 3);
    ASSERT_TRUE(agrees(sut, *server));
    const std::uint32_t revision = sut.frame.revision();
    sut.reader.end(0);
    sut.reader.end(0); // Edits behind the refused one were in the mailbox.
    publish(*server, kKeptEdits);
    ASSERT_TRUE(agrees(witness, *server));
    for (const std::uint64_t epoch : {server->epoch(), std::uint64_t{0}, server->epoch()})
    {
        sut.reader.follow(0, epoch);
        sut.step();
    }
    EXPECT_EQ(sut.frame.revision(), revision);
    EXPECT_TRUE(sut.reader.counts(0).is_stopped);
    EXPECT_EQ(sut.reader.counts(0).refused, 1U);
    EXPECT_FALSE(sut.reader.number_of(0)); // No more requests either.
    EXPECT_TRUE(sut.lines.has("model 'tiny': a frame has refused an edit"));
}

EditRequest some_request(const DdsServer& server)
{
    EditRequest request;
    request.server_epoch = server.epoch();
    request.radius_m = 0.002;
    request.to.translation_m = {0.01, 0.02, 0.03};
    return request;
}

/// Sends until the request is on its way.
testing::AssertionResult sends(Controller& controller, const EditRequest& request)
{
    return eventually([&] { return controller.writer.try_send(request); })
               ? testing::AssertionSuccess()
               : testing::AssertionFailure() << "no reader";
}

TEST_F(DdsEdits, requests_arrive_in_order_with_all_values)
{
    Controller sut(2, model);
    EditRequest request = some_request(*server);
    request.kind = EditKind::displace;
    request.amount_m = -0.001;
    request.hull_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    request.from.rotation = {0.0, 0.0, 1.0, 0.0};
    for (std::uint64_t serial = 1; serial <= 10; ++serial)
    {
        ASSERT_TRUE(sends(sut, request));
    }
    request.controller = sut.domain().participants().own();
    std::vector<EditRequest> got;
    ASSERT_TRUE(both_until(sut,
                           [&]
                           {
                               while (auto one = server->edits()->take())
                               {
                                   got.push_back(std::move(*one));
                               }
                               return got.size() == 10;
                           }));
    for (const EditRequest& one : got)
    {
        ++request.serial;
        EXPECT_EQ(one, request);
    }
    EXPECT_EQ(server->edits()->counters().requests, 10U);
}

TEST_F(DdsEdits, unsound_requests_are_not_sent)
{
    EditWriter sut(server->domain());
    const auto expect_unsound = [&](auto change)
    {
        EditRequest request = some_request(*server);
        ASSERT_TRUE(is_sound(request));
        change(request);
        EXPECT_FALSE(is_sound(request));
        EXPECT_FALSE(sut.try_send(request));
    };
    expect_unsound([](EditRequest& request) { request.radius_m = kNan; });
    expect_unsound([](EditRequest& request) { request.radius_m = -1.0; });
    expect_unsound([](EditRequest& request) { request.radius_m = 2 * kPoseReachMax_m; });
    expect_unsound([](EditRequest& request) { request.radius_m = 0.0; });
    expect_unsound([](EditRequest& request) { request.half_axis_m[1] = kNan; });
    expect_unsound([](EditRequest& request) { request.hull_m.resize(kMaxHullVertices + 1); });
    expect_unsound([](EditRequest& request) { request.hull_m = {{0.0, kNan, 0.0}}; });
    expect_unsound(
        [](EditRequest& request)
        {
            request.hull_m.resize(4);
            request.half_axis_m[0] = 1.0;
        });
    expect_unsound([](EditRequest& request) { request.amount_m = 1.0; });
    expect_unsound([](EditRequest& request) { request.kind = EditKind::displace; });
    expect_unsound([](EditRequest& request) { request.kind = static_cast<EditKind>(3); });
    expect_unsound([](EditRequest& request) { request.from.rotation = {}; });
    expect_unsound([](EditRequest& request) { request.to.translation_m[2] = kNan; });
    expect_unsound([](EditRequest& request) { request.to.scale = 0.0; });
}

TEST_F(DdsEdits, requests_of_others_and_impossible_ones_are_refused_at_the_door)
{
    other = make_server(3, {false, {"no-such-machine"}});
    Controller sut(2, model);
    EditRequest unknown = some_request(*server);
    unknown.model = 1;
    ASSERT_TRUE(sends(sut, unknown));
    ASSERT_TRUE(sends(sut, some_request(*other)));
    const auto count = [](DdsServer& by)
    {
        EXPECT_FALSE(by.edits()->take());
        return by.edits()->counters().requests_refused;
    };
    ASSERT_TRUE(both_until(sut, [&] { return count(*server) == 1 && count(*other) == 1; }));
    EXPECT_EQ(refused(server->domain(), Refused::edit_request), 1U);
    // A sample that a sound program never sends.
    const Endpoint writer = std::move(make_writer(sut.domain(), Topic::edit_requests,
                                                  server_partition(server->epoch())))
                                .value();
    ASSERT_TRUE(both_until(sut, [&] { return is_matched(writer); }));
    tactus_v5_EditRequests wire = {};
    const ControllerId& own = sut.domain().participants().own();
    std::memcpy(wire.controller, own.data(), own.size());
    wire.server_epoch = server->epoch();
    wire.radius_m = kNan;
    dds_write(writer.handle, &wire);
    ASSERT_TRUE(both_until(sut, [&] { return count(*server) == 2; }));
    wire.controller[0] ^= 1U; // In the name of another controller.
    dds_write(writer.handle, &wire);
    ASSERT_TRUE(both_until(sut,
                           [&]
                           {
                               EXPECT_FALSE(server->edits()->take());
                               return refused(server->domain(), Refused::identity) == 1;
                           }));
}

} // namespace
} // namespace tactus::dds
