// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Many servers of one name: hashes prove all pieces, so a silent or forging server is skipped; the
/// authority stays with the first, unless another is allowed.

#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/stranger.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/base_fetch.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/authority.hpp"
#include "transport/dds/dds_client.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tactus::dds
{
namespace
{

using test::eventually;
using test::Forgery;
using test::kPatience;
using test::Lines;
using test::make_tiny_model;
using test::Stranger;
using test::TinyModel;

/// Keeps the true chunks and rejects the others.
struct Verifier final : PieceSink
{
    Verifier(const TinyModel& model, ChunkLink& link) : model_(model), link_(link) {}
    void receive(ContentKey key, std::span<const std::byte> bytes) override
    {
        if (std::ranges::equal(bytes, model_.piece(key)))
        {
            chunks.insert(key.number);
        }
        else
        {
            ++wrong;
            static_cast<void>(link_.distrust(key));
        }
    }
    std::set<std::uint32_t> chunks;
    int wrong{0};

private:
    const TinyModel& model_;
    ChunkLink& link_;
};

struct DdsServers : ::testing::Test
{
    void SetUp() override
    {
        test::isolate_domains();
        client_ = std::move(DdsClient::create(kClientDomain, "hand", lines.log())).value();
    }

    void start_anew()
    {
        strangers.clear();
        client_.reset(); // An existing domain keeps its configuration.
        SetUp();
    }

    /// Adds a server in its own domain, discovered after the earlier ones.
    Stranger& come(const TinyModel& of, std::string scene = "")
    {
        const auto domain = static_cast<std::uint32_t>(strangers.size());
        strangers.push_back(std::make_unique<Stranger>(domain, of, "tiny", std::move(scene)));
        EXPECT_TRUE(step_until([&] { return catalogue().has_server(strangers.back()->epoch()); }));
        return *strangers.back();
    }
    [[nodiscard]] Catalogue& catalogue() { return client_->catalogue(); }
    void step()
    {
        for (const auto& stranger : strangers)
        {
            stranger != nullptr ? stranger->step() : void();
        }
        client_->exchange().step();
    }
    bool step_until(const std::function<bool()>& is_so)
    {
        return eventually(
            [&]
            {
                step();
                return is_so();
            });
    }
    Result<std::vector<ServedModel>, Refusal> find(const ModelSelector& selector)
    {
        return client_->find_headers({&selector, 1}, kPatience,
                                     [this]
                                     {
                                         step();
                                         return true;
                                     });
    }

    static constexpr std::uint32_t kClientDomain = 50;
    const TinyModel model = make_tiny_model({.records = 64 * 8});
    const ContentHash hash = model_hash(model.header);
    Lines lines;
    std::vector<std::unique_ptr<Stranger>> strangers;
    std::unique_ptr<DdsClient> client_;
};

TEST_F(DdsServers, a_header_comes_from_the_next_where_the_first_is_silent_or_lies)
{
    const TinyModel other = make_tiny_model({.seed = 2});
    for (const Forgery how : {Forgery::withheld, Forgery::another_byte})
    {
        start_anew();
        come(model).forge(ContentKind::header, how);
        come(other).forge(ContentKind::header, how); // The name with another hash.
        const Stranger& honest = come(model);
        const auto found = find({"tiny"});
        ASSERT_TRUE(found) << found.error().text;
        EXPECT_TRUE(std::ranges::equal(found.value()[0].header, model.header));
        EXPECT_EQ(found.value()[0].server_epoch, honest.epoch());
    }
}

TEST_F(DdsServers, a_base_mesh_comes_from_the_next_where_the_first_is_silent_or_lies)
{
    for (const Forgery how : {Forgery::withheld, Forgery::another_byte})
    {
        start_anew();
        come(model).forge(ContentKind::base, how);
        come(model);
        auto found = find({"tiny"});
        ASSERT_TRUE(found) << found.error().text;
        EXPECT_EQ(found.value()[0].server_epoch, strangers[0]->epoch());
        const auto refusal = fetch_base_meshes(found.value(), kPatience,
                                               [this]
                                               {
                                                   step();
                                                   return true;
                                               });
        EXPECT_FALSE(refusal) << refusal->text;
        EXPECT_TRUE(std::ranges::equal(found.value()[0].base, model.base));
    }
}

TEST_F(DdsServers, a_base_mesh_that_all_forge_is_refused)
{
    come(model).forge(ContentKind::base, Forgery::another_byte);
    come(model).forge(ContentKind::base, Forgery::another_byte);
    auto found = find({"tiny"});
    ASSERT_TRUE(found) << found.error().text;
    const auto refusal = fetch_base_meshes(found.value(), kPatience,
                                           [this]
                                           {
                                               step();
                                               return true;
                                           });
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->text,
              "model 'tiny' has a base mesh that does not match the hash in its header");
}

TEST_F(DdsServers, pieces_come_from_the_next_where_the_first_is_silent_or_lies)
{
    for (const Forgery how : {Forgery::withheld, Forgery::another_byte})
    {
        start_anew();
        Stranger& first = come(model);
        first.forge(ContentKind::chunk, how);
        come(model);
        auto found = find({"tiny"});
        ASSERT_TRUE(found) << found.error().text;
        ChunkLink& link = *found.value()[0].link;
        Verifier got(model, link);
        std::vector<ContentKey> keys;
        for (std::uint32_t chunk = 0; chunk < model.chunks.size(); ++chunk)
        {
            keys.push_back({ContentKind::chunk, chunk});
        }
        link.request(keys, 1); // Once: the requester need not know.
        ASSERT_TRUE(step_until(
            [&]
            {
                link.poll(got);
                return got.chunks.size() == keys.size();
            }))
            << got.chunks.size();
        EXPECT_EQ(link.session(), 1U);
        EXPECT_TRUE(lines.has(how == Forgery::withheld
                                  ? "doesn't answer; pieces are now requested from "
                                  : "sends wrong data; pieces are now requested from "))
            << lines.text();
        const int sent = first.sent(ContentKind::chunk);
        got.chunks.clear();
        link.request(keys, 2); // All requests go to the second one from now on.
        ASSERT_TRUE(step_until(
            [&]
            {
                link.poll(got);
                return got.chunks.size() == keys.size();
            }));
        EXPECT_EQ(first.sent(ContentKind::chunk), sent);
    }
}

TEST_F(DdsServers, a_piece_that_one_alone_lacks_comes_from_the_next)
{
    come(model).forge(ContentKind::index_page, Forgery::withheld);
    come(model);
    auto found = find({"tiny"});
    ASSERT_TRUE(found) << found.error().text;
    ChunkLink& link = *found.value()[0].link;
    Verifier got(model, link);
    const std::vector<ContentKey> index{{ContentKind::index_page, 0}};
    std::uint32_t chunk = 0;
    link.request(index, 1);
    ASSERT_TRUE(step_until(
        [&]
        {
            const std::vector<ContentKey> other{
                {ContentKind::chunk, 1 + chunk++ % 3}}; // The first one always answers.
            link.request(other, 1);
            link.poll(got);
            return got.chunks.contains(0); // Chunk 0 of the index page.
        }));
    EXPECT_FALSE(lines.has("doesn't answer")) << lines.text();
}

TEST_F(DdsServers, a_server_that_is_asked_for_by_its_name_is_the_only_one_that_is_asked)
{
    const TinyModel other = make_tiny_model({.seed = 2});
    come(other);
    Stranger& second = come(model);
    const Participants& participants = catalogue().participants();
    const std::string name = participants.name_of(catalogue().offers_of(second.epoch())[0]->server);
    const std::size_t on = name.rfind(" on ");
    ASSERT_NE(on, std::string::npos) << name;
    const std::string machine = name.substr(on + 4, name.size() - on - 5);
    EXPECT_EQ(catalogue().offers({"tiny", {}, machine}).size(), 2U);
    const std::string process = machine + ":" + std::to_string(::getpid());
    EXPECT_EQ(catalogue().offers({"tiny", {}, process}).size(), 2U);
    EXPECT_TRUE(catalogue().offers({"tiny", {}, machine + ":1"}).empty());
    EXPECT_TRUE(catalogue().offers({"tiny", {}, "cert:91d177d5d766"}).empty());
    const ModelSelector absent{"tiny", {}, "elsewhere"};
    const auto refused = client_->find_headers({&absent, 1}, std::chrono::milliseconds(50));
    ASSERT_FALSE(refused);
    EXPECT_TRUE(refused.error().text.starts_with("model 'tiny@elsewhere' is not published on"))
        << refused.error().text;
}

TEST_F(DdsServers, what_is_asked_for_is_kept_however_many_others_there_are)
{
    constexpr std::size_t kRoom = 64;
    const auto domain = std::move(Domain::join(kClientDomain + 1)).value();
    auto sut = std::move(Catalogue::create(domain, lines.log(), kRoom)).value();
    sut.ask_for({"wanted"});
    std::vector<Domain> crowd;
    std::vector<Endpoint> writers;
    const auto announce = [&](std::size_t who, std::uint32_t number, const std::string& name)
    {
        tactus_v5_CatalogueEntry entry = {};
        entry.server_epoch = crowd[who].participants().own_epoch();
        entry.model = number;
        name.copy(static_cast<char*>(entry.name), kMaxNameBytes);
        dds_write(writers[who].handle, &entry);
    };
    for (std::uint32_t who = 0; who < 5; ++who)
    {
        crowd.push_back(std::move(Domain::join(who)).value());
        writers.push_back(std::move(make_writer(crowd.back(), Topic::catalogue, "")).value());
    }
    const auto share = [&](std::size_t who)
    { return sut.offers_of(crowd[who].participants().own_epoch()).size(); };
    const auto settled = [&](const std::function<bool()>& is_so)
    {
        return eventually(
            [&]
            {
                sut.refresh();
                return is_so();
            });
    };
    // Four servers with many irrelevant names; each has an equal share.
    for (std::uint32_t who = 0; who < 4; ++who)
    {
        for (std::uint32_t i = 0; i < 100; ++i)
        {
            announce(who, i, "bogus-" + std::to_string(i));
        }
        ASSERT_TRUE(settled([&] { return share(who) >= kRoom / 4 - 1; })) << share(who);
    }
    EXPECT_EQ(sut.offers({}).size(), kRoom);
    // The one with the requested name has space, also for other names.
    announce(4, 0, "wanted");
    announce(4, 1, "other");
    EXPECT_TRUE(settled([&] { return share(4) == 2; }));
    EXPECT_EQ(sut.offers({}).size(), kRoom);
    // Strangers with that name do not displace it: none exceeds its share.
    for (std::uint32_t who = 0; who < 4; ++who)
    {
        for (std::uint32_t i = 100; i < 200; ++i)
        {
            announce(who, i, "wanted");
        }
    }
    ASSERT_TRUE(settled([&] { return sut.offers({"wanted"}).size() == kRoom; }));
    EXPECT_EQ(share(4), 1U);
    announce(4, 2, "wanted");
    EXPECT_TRUE(settled([&] { return share(4) == 2; }));
    // All entries of an authoritative server are kept.
    sut.keep(crowd[4].participants().own_epoch());
    announce(4, 1, "other");
    EXPECT_TRUE(settled([&] { return share(4) == 3; }));
    EXPECT_GE(domain.participants().refusals().list().size(), 1U);
}

TEST_F(DdsServers, the_first_server_s_word_counts_until_it_is_gone_and_another_s_where_allowed)
{
    const auto events_of = [](const Authority& authority)
    {
        std::string text;
        for (const ServerEvent& event : authority.events())
        {
            text += server_news_names().at(static_cast<std::size_t>(event.news)) + std::string(" ");
        }
        return text;
    };
    Stranger& first = come(model, "toys");
    Authority strict(catalogue(), {"toys"}, true, {}, lines.log());
    Authority open(catalogue(), {"toys"}, true, {.any = true}, lines.log());
    Authority listed(catalogue(), {"tiny", hash}, false, {false, {"elsewhere"}}, lines.log());
    const std::uint64_t true_epoch = first.epoch();
    catalogue().ask_for_scene("toys");
    for (Authority* authority : {&strict, &open, &listed})
    {
        authority->pin(true_epoch);
    }
    const auto step_all = [&]
    {
        for (Authority* authority : {&strict, &open, &listed})
        {
            authority->step();
        }
    };
    const Stranger& second = come(model, "toys");
    step_all();
    EXPECT_EQ(open.server(), true_epoch);
    EXPECT_TRUE(lines.has("warning: scene 'toys' is offered by a second server, "));
    EXPECT_TRUE(lines.has("warning: model 'tiny' is offered by a second server, "));
    strangers[0].reset();
    ASSERT_TRUE(step_until([&] { return !catalogue().has_server(true_epoch); }));
    step_all();
    EXPECT_EQ(strict.server(), true_epoch);
    EXPECT_FALSE(strict.is_resident());
    EXPECT_EQ(listed.server(), true_epoch);
    EXPECT_FALSE(listed.is_resident());
    EXPECT_EQ(open.server(), second.epoch());
    EXPECT_TRUE(open.is_resident());
    EXPECT_EQ(events_of(strict), "pinned namesake lost not_followed ");
    EXPECT_EQ(events_of(listed), "pinned namesake lost not_followed ");
    EXPECT_EQ(events_of(open), "pinned namesake lost replaced ");
    EXPECT_TRUE(lines.has("--failover allows no other")) << lines.text();
}

} // namespace
} // namespace tactus::dds
