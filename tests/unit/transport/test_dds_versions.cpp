// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Foreign participants: those with another protocol version are named and skipped, those with a
/// false identity are ignored, and neither affects honest ones.

#include "tests/shared/count_of.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/piece_frame.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include "tactus.h"

namespace tactus::dds
{
namespace
{

using namespace std::chrono_literals;
using test::kPatience;
using test::make_tiny_model;
using test::TemporaryFolder;
using test::TinyModel;

/// Wait for an event that must not occur.
constexpr auto kMoment = 300ms;

struct Nobody final : PieceSink
{
    void receive(ContentKey /*key*/, std::span<const std::byte> /*bytes*/) override { ++count; }
    std::size_t count{0};
};

/// Server, controller and stranger as three domains of this process on loopback; server and
/// controller run in turn on one thread.
struct DdsVersions : ::testing::Test
{
    static constexpr std::uint32_t kServerDomain = 1;
    static constexpr std::uint32_t kClientDomain = 2;
    static constexpr std::uint32_t kStrangerDomain = 3;

    void SetUp() override
    {
        test::isolate_domains();
        auto joined = Domain::join(kStrangerDomain);
        ASSERT_TRUE(joined) << joined.error().text;
        stranger = std::move(joined).value();
        auto created = DdsClient::create(kClientDomain, "ours", log_into(lines));
        ASSERT_TRUE(created) << created.error().text;
        client = std::move(created).value();
    }

    static Log log_into(std::string& text)
    {
        return [&text](const std::string& line) { text += line + "\n"; };
    }
    /// Steps both until the condition holds or the time is over; returns the condition.
    [[nodiscard]] bool step_until(const std::function<bool()>& is_so,
                                  std::chrono::nanoseconds patience = kPatience)
    {
        const auto start = std::chrono::steady_clock::now();
        while (!is_so() && std::chrono::steady_clock::now() - start < patience)
        {
            step();
            std::this_thread::sleep_for(1ms);
        }
        return is_so();
    }
    /// Steps until the server has announced its models again.
    void step_for_an_announcement()
    {
        static_cast<void>(step_until([] { return false; }, 1'100ms));
    }
    void step()
    {
        if (server)
        {
            server->step();
        }
        if (link)
        {
            link->poll(got);
        }
    }
    /// Creates our server, and our controller with its model.
    void connect()
    {
        std::vector<PublishedModel> models;
        models.push_back({"tiny", ModelStore::open(folder.write("tiny", model.file)).value()});
        auto created = DdsServer::create(kServerDomain, std::move(models), log_into(server_lines));
        ASSERT_TRUE(created) << created.error().text;
        server = std::move(created).value();
        auto found = client->find({"tiny", std::nullopt}, kPatience,
                                  [&]
                                  {
                                      step();
                                      return true;
                                  });
        ASSERT_TRUE(found) << found.error().text;
        link = std::move(found.value().link);
        ASSERT_TRUE(step_until([&] { return server->subscribers().size() == 1; }));
    }

    /// True if our controller still gets its requests.
    [[nodiscard]] bool is_served()
    {
        const ContentKey key{ContentKind::chunk, 0};
        const std::size_t before = got.count;
        link->request({&key, 1}, 1);
        return step_until([&] { return got.count > before; }) && got.count == before + 1;
    }
    /// Writer of the stranger with a matched reader.
    [[nodiscard]] Endpoint heard_writer(Topic topic, const std::string& partition)
    {
        Endpoint writer = make_writer(stranger, topic, partition).value();
        EXPECT_TRUE(step_until([&] { return is_matched(writer); }));
        return writer;
    }
    /// Announcement of a server, which lasts as long as the writer.
    [[nodiscard]] Endpoint announce(std::uint64_t epoch) const
    {
        Endpoint writer = make_writer(stranger, Topic::catalogue, "").value();
        tactus_v5_CatalogueEntry entry = {};
        std::strcpy(static_cast<char*>(entry.name), "tiny");
        entry.server_epoch = epoch;
        entry.header_bytes = entry.base_bytes = 100;
        const ContentHash hash = model_hash(model.header);
        std::memcpy(entry.model_hash, hash.data(), hash.size());
        EXPECT_EQ(dds_write(writer.handle, &entry), DDS_RETCODE_OK);
        return writer;
    }
    [[nodiscard]] tactus_v5_Wanted request(const ControllerId& controller,
                                           const std::string& name) const
    {
        tactus_v5_Wanted wanted = {};
        std::memcpy(wanted.controller, controller.data(), controller.size());
        name.copy(static_cast<char*>(wanted.controller_name), kMaxNameBytes);
        wanted.server_epoch = server->epoch();
        wanted.granted = kCreditPieces;
        return wanted;
    }
    /// Topic of another version; its type is irrelevant for readers of names.
    [[nodiscard]] Entity topic_of_version(const std::string& name) const
    {
        return Entity(dds_create_topic(stranger.participant(), &tactus_v5_CatalogueEntry_desc,
                                       name.c_str(), nullptr, nullptr));
    }

    TinyModel model{make_tiny_model({})};
    TemporaryFolder folder;
    std::string lines;
    std::string server_lines;
    Domain stranger;
    std::unique_ptr<DdsServer> server;
    std::unique_ptr<DdsClient> client;
    std::unique_ptr<ChunkLink> link;
    Nobody got;
};

TEST_F(DdsVersions, who_speaks_another_version_is_named_once_by_both_sides_and_passed_over)
{
    ASSERT_NO_FATAL_FAILURE(connect());
    const Entity catalogue = topic_of_version("tactus/v1/catalogue");
    const Entity wanted = topic_of_version("tactus/v1/wanted");
    const Entity other = topic_of_version("other/v1/wanted");
    const Entity server_writer(
        dds_create_writer(stranger.participant(), catalogue.get(), nullptr, nullptr));
    const Entity controller_writer(
        dds_create_writer(stranger.participant(), wanted.get(), nullptr, nullptr));
    const Entity foreign(dds_create_writer(stranger.participant(), other.get(), nullptr, nullptr));
    tactus_v5_CatalogueEntry entry = {};
    std::strcpy(static_cast<char*>(entry.name), "old");
    ASSERT_EQ(dds_write(server_writer.get(), &entry), DDS_RETCODE_OK);
    const std::string line = "is refused: its protocol version is 1, this build's is 5";
    EXPECT_TRUE(step_until(
        [&] {
            return lines.find(line) != std::string::npos &&
                   server_lines.find(line) != std::string::npos;
        }));
    EXPECT_FALSE(step_until([&] { return test::count_of(lines, line) > 1; }, kMoment)) << lines;
    EXPECT_EQ(test::count_of(server_lines, line), 1U) << server_lines;
    const std::string who = "(process " + std::to_string(::getpid());
    EXPECT_NE(lines.find(who), std::string::npos) << lines;
    EXPECT_EQ(client->catalogue().find({"old", std::nullopt}), nullptr);
    EXPECT_TRUE(is_served());
}

TEST_F(DdsVersions, who_says_to_be_another_server_is_not_heard)
{
    const Endpoint lie = announce(stranger.participants().own_epoch() + 1);
    const auto alone = client->find({"tiny", std::nullopt}, kMoment);
    ASSERT_FALSE(alone);
    EXPECT_NE(alone.error().text.find("is not published"), std::string::npos) << alone.error().text;
    const Endpoint truth = announce(stranger.participants().own_epoch());
    EXPECT_TRUE(step_until(
        [&]
        {
            client->exchange().step();
            return client->catalogue().find({"tiny", std::nullopt}) != nullptr;
        }));
}

/// Every participant may dispose any instance, and filters do not see it.
TEST_F(DdsVersions, who_is_not_the_server_can_not_end_it_nor_hide_its_end)
{
    ASSERT_NO_FATAL_FAILURE(connect());
    const Endpoint writer = heard_writer(Topic::catalogue, "");
    tactus_v5_CatalogueEntry entry = {};
    entry.server_epoch = server->epoch();
    const auto refused = [&]
    {
        for (const PeerRefusals& peer : client->domain().participants().refusals().list())
        {
            EXPECT_EQ(peer.id, stranger.participants().own());
            return peer.counts.at(static_cast<std::size_t>(Refused::identity));
        }
        return std::uint64_t{0};
    };
    for (std::uint64_t i = 1; i <= 3; ++i)
    {
        ASSERT_EQ(dds_dispose(writer.handle, &entry), DDS_RETCODE_OK);
        ASSERT_TRUE(step_until([&] { return refused() == i; }));
        EXPECT_EQ(link->state(), LinkState::connected);
        step_for_an_announcement();
    }
    ASSERT_EQ(dds_dispose(writer.handle, &entry), DDS_RETCODE_OK);
    ASSERT_TRUE(step_until([&] { return refused() == 4; }));
    EXPECT_EQ(lines.find("gone"), std::string::npos) << lines;
    server.reset();
    EXPECT_TRUE(step_until([&] { return link->state() == LinkState::server_gone; }));
}

TEST_F(DdsVersions, who_is_not_the_controller_can_not_end_it_nor_hide_its_end)
{
    ASSERT_NO_FATAL_FAILURE(connect());
    const Endpoint writer = heard_writer(Topic::wanted, "ours");
    const tactus_v5_Wanted wanted = request(client->domain().participants().own(), "ours");
    ASSERT_EQ(dds_dispose(writer.handle, &wanted), DDS_RETCODE_OK);
    ASSERT_TRUE(
        step_until([&] { return !server->domain().participants().refusals().list().empty(); }));
    EXPECT_EQ(server->subscribers().size(), 1U);
    EXPECT_TRUE(is_served());
    EXPECT_EQ(server_lines.find("left ("), std::string::npos) << server_lines;
    link.reset();
    client.reset();
    EXPECT_TRUE(step_until([&] { return server->subscribers().empty(); }));
}

/// A sample that is not taken yet then reports an end, in its sender's name.
TEST_F(DdsVersions, an_end_that_a_stranger_put_on_what_was_not_taken_yet_is_not_believed)
{
    ASSERT_NO_FATAL_FAILURE(connect());
    const Endpoint wants = heard_writer(Topic::wanted, "ours");
    const Endpoint shows = heard_writer(Topic::catalogue, "");
    const tactus_v5_Wanted wanted = request(client->domain().participants().own(), "ours");
    tactus_v5_CatalogueEntry entry = {};
    entry.server_epoch = server->epoch();
    constexpr auto kOnItsWay = 20ms;
    for (std::uint32_t i = 1; i <= 10; ++i)
    {
        const std::vector<ContentKey> keys{{ContentKind::chunk, 0}};
        link->request(keys, i);
        link->poll(got);
        std::this_thread::sleep_for(kOnItsWay);
        ASSERT_EQ(dds_dispose(wants.handle, &wanted), DDS_RETCODE_OK);
        std::this_thread::sleep_for(kOnItsWay);
        server->step();
        ASSERT_EQ(server->subscribers().size(), 1U) << i << server_lines;
    }
    for (int i = 0; i < 2; ++i)
    {
        std::unique_ptr<ChunkLink> untaken = std::move(link); // The link's messages wait.
        step_for_an_announcement();
        link = std::move(untaken);
        ASSERT_EQ(dds_dispose(shows.handle, &entry), DDS_RETCODE_OK);
        std::this_thread::sleep_for(kOnItsWay);
        link->poll(got);
        EXPECT_EQ(link->state(), LinkState::connected) << lines;
    }
    EXPECT_EQ(server_lines.find("left ("), std::string::npos) << server_lines;
    EXPECT_EQ(lines.find("gone"), std::string::npos) << lines;
    link.reset();
    client.reset();
    EXPECT_TRUE(step_until([&] { return server->subscribers().empty(); }));
}

TEST_F(DdsVersions, pieces_of_who_says_to_be_the_server_are_not_taken)
{
    ASSERT_NO_FATAL_FAILURE(connect());
    const ControllerId us = client->domain().participants().own();
    const Endpoint writer = heard_writer(Topic::chunks, controller_partition("ours", us));
    std::vector<std::byte> payload;
    append_piece(payload, {model_hash(model.header), 0, 2, 0}, std::vector<std::byte>(10));
    tactus_v5_Pieces sample = {};
    sample.server_epoch = server->epoch();
    sample.sent = 1'000'000;
    const auto length = static_cast<std::uint32_t>(payload.size());
    sample.payload = {length, length, reinterpret_cast<std::uint8_t*>(payload.data()), false};
    ASSERT_EQ(dds_write(writer.handle, &sample), DDS_RETCODE_OK);
    EXPECT_FALSE(step_until([&] { return got.count > 0; }, kMoment));
    EXPECT_TRUE(is_served());
}

TEST_F(DdsVersions, a_controller_is_served_under_its_own_id_and_a_valid_name_only)
{
    ASSERT_NO_FATAL_FAILURE(connect());
    const Endpoint writer = heard_writer(Topic::wanted, "stranger");
    const ControllerId own = stranger.participants().own();
    ControllerId other = own;
    other[3] ^= 1U;
    tactus_v5_Wanted wanted = request(other, "stranger");
    ASSERT_EQ(dds_write(writer.handle, &wanted), DDS_RETCODE_OK);
    wanted = request(own, "strange\n\x1b[31m*");
    ASSERT_EQ(dds_write(writer.handle, &wanted), DDS_RETCODE_OK);
    ASSERT_TRUE(step_until([&] { return server->counters().requests_refused == 1; }));
    EXPECT_EQ(server->subscribers().size(), 1U);
    EXPECT_EQ(test::count_of(server_lines, "is refused: its name is not"), 1U) << server_lines;
    EXPECT_EQ(server_lines.find('\x1b'), std::string::npos);
    const auto refused = server->domain().participants().refusals().list();
    ASSERT_EQ(refused.size(), 1U);
    EXPECT_EQ(refused[0].id, own);
    EXPECT_EQ(refused[0].counts.at(static_cast<std::size_t>(Refused::identity)), 1U);
    EXPECT_EQ(refused[0].counts.at(static_cast<std::size_t>(Refused::controller)), 1U);
    wanted = request(own, "stranger");
    ASSERT_EQ(dds_write(writer.handle, &wanted), DDS_RETCODE_OK);
    EXPECT_TRUE(step_until([&] { return server->subscribers().size() == 2; }));
}

TEST_F(DdsVersions, nobody_gets_more_pieces_than_a_window_beyond_what_it_has_seen)
{
    ASSERT_NO_FATAL_FAILURE(connect());
    const ControllerId own = stranger.participants().own();
    const Endpoint reader =
        make_reader(stranger, Topic::chunks, controller_partition("stranger", own)).value();
    const Endpoint writer = heard_writer(Topic::wanted, "stranger");
    std::array<tactus_v5_PieceName, 1> names{{{0, 2, 0}}};
    tactus_v5_Wanted wanted = request(own, "stranger");
    wanted.seen = 0;
    wanted.granted = std::uint64_t{1} << 63U;
    wanted.pieces = {1, 1, names.data(), false};
    const auto sent = [&]
    {
        for (const DdsServer::Subscriber& each : server->subscribers())
        {
            if (each.controller == "stranger")
            {
                return each.pieces_sent;
            }
        }
        return std::uint64_t{0};
    };
    ASSERT_TRUE(step_until(
        [&]
        {
            dds_write(writer.handle, &wanted);
            return sent() >= kCreditPieces;
        }));
    for (int i = 0; i < 10; ++i)
    {
        const std::uint64_t requests = server->counters().requests;
        dds_write(writer.handle, &wanted);
        ASSERT_TRUE(step_until([&] { return server->counters().requests > requests; }));
    }
    EXPECT_EQ(sent(), kCreditPieces);
    wanted.seen = UINT64_MAX; // More than was sent.
    ASSERT_TRUE(step_until(
        [&]
        {
            dds_write(writer.handle, &wanted);
            return sent() > kCreditPieces;
        }));
    EXPECT_LE(sent(), 3 * kCreditPieces) << "a request at a time";
    EXPECT_TRUE(is_served());
}

TEST_F(DdsVersions, who_asks_for_too_much_in_a_second_is_counted_by_name_and_served_a_second_later)
{
    ASSERT_NO_FATAL_FAILURE(connect());
    const ControllerId own = stranger.participants().own();
    const Endpoint writer = heard_writer(Topic::wanted, "stranger");
    std::vector<tactus_v5_PieceName> names(kMaxRequests, {0, 2, 0});
    tactus_v5_Wanted wanted = request(own, "stranger");
    wanted.pieces = {kMaxRequests, kMaxRequests, names.data(), false};
    const auto refused = [&]
    {
        const auto list = server->domain().participants().refusals().list();
        return list.empty() ? 0 : list[0].counts.at(static_cast<std::size_t>(Refused::rate));
    };
    ASSERT_TRUE(test::eventually(
        [&]
        {
            for (int i = 0; i < 16; ++i) // Number that a reader keeps.
            {
                dds_write(writer.handle, &wanted);
            }
            server->step();
            return refused() > 0;
        }));
    // All are in one process: a second later it is served again.
    const ContentKey key{ContentKind::chunk, 0};
    EXPECT_TRUE(step_until(
        [&]
        {
            link->request({&key, 1}, 1);
            return got.count > 0;
        }));
    EXPECT_TRUE(step_until(
        [&]
        { return server_lines.find("more pieces requested in a second") != std::string::npos; }));
}

} // namespace
} // namespace tactus::dds
