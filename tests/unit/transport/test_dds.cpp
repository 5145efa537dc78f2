// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/sanitizers.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/base_fetch.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/header_fetch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <netinet/in.h>
#include <spawn.h>
#include <string>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#if TACTUS_HAS_ADDRESS_SANITIZER
#include <sanitizer/lsan_interface.h>
#endif

namespace tactus::dds
{
namespace
{

using namespace std::chrono_literals;
using test::eventually;
using test::kPatience;
using test::Lines;
using test::make_tiny_model;
using test::TemporaryFolder;
using test::TinyModel;

const std::array<ModelSelector, 1> kTiny{ModelSelector{"tiny"}};

/// Scope in which Cyclone DDS 0.10 leaks: a domain that cannot be joined for its ports. The address
/// sanitizer ignores this thread's allocations for its lifetime.
struct CycloneLosesMemory
{
#if TACTUS_HAS_ADDRESS_SANITIZER
    const __lsan::ScopedDisabler unseen;
#endif
};

/// Devices to which this process's UDP sockets with a wildcard address are bound; an empty text
/// means none.
std::vector<std::string> devices_of_open_sockets()
{
    std::vector<std::string> devices;
    for (int descriptor = 0; descriptor < 1'024; ++descriptor)
    {
        int kind = 0;
        socklen_t size = sizeof(kind);
        sockaddr_in address{};
        socklen_t address_size = sizeof(address);
        if (::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &kind, &size) != 0 ||
            kind != SOCK_DGRAM ||
            ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &address_size) != 0 ||
            address.sin_family != AF_INET || address.sin_addr.s_addr != 0)
        {
            continue;
        }
        std::array<char, 64> name{};
        socklen_t name_size = name.size();
        EXPECT_EQ(::getsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, name.data(), &name_size),
                  0);
        devices.emplace_back(name.data());
    }
    return devices;
}

/// Server in its own thread and DDS domain, which communicates with the client's domain over
/// loopback sockets, as between processes.
struct ServerThread
{
    ServerThread(std::uint32_t domain, std::vector<PublishedModel> models, Log log)
    {
        auto created = DdsServer::create(domain, std::move(models), std::move(log));
        if (!created)
        {
            ADD_FAILURE() << created.error().text;
            return;
        }
        server_ = std::move(created).value();
        thread_ = std::thread(
            [this]
            {
                while (!stop_)
                {
                    server_->wait(10ms);
                    server_->step();
                    const std::lock_guard lock(mutex_);
                    counters_ = server_->counters();
                    subscribers_ = server_->subscribers();
                }
            });
    }
    ~ServerThread()
    {
        stop_ = true;
        if (thread_.joinable())
        {
            thread_.join();
        }
    }
    ServerThread(const ServerThread&) = delete;
    ServerThread& operator=(const ServerThread&) = delete;

    [[nodiscard]] DdsServer::Counters counters()
    {
        const std::lock_guard lock(mutex_);
        return counters_;
    }
    [[nodiscard]] std::vector<DdsServer::Subscriber> subscribers()
    {
        const std::lock_guard lock(mutex_);
        return subscribers_;
    }

private:
    std::unique_ptr<DdsServer> server_;
    std::mutex mutex_;
    DdsServer::Counters counters_;
    std::vector<DdsServer::Subscriber> subscribers_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

/// Keeps and counts all received pieces.
struct Collector final : PieceSink
{
    void receive(ContentKey key, std::span<const std::byte> bytes) override
    {
        pieces[{key.kind, key.number}].assign(bytes.begin(), bytes.end());
        ++count;
    }
    std::map<std::pair<ContentKind, std::uint32_t>, std::vector<std::byte>> pieces;
    std::size_t count{0};
};

struct Dds : ::testing::Test
{
    static constexpr std::uint32_t kServerDomain = 1; // Within this process; see SetUp.
    static constexpr std::uint32_t kOtherServerDomain = 2;
    static constexpr std::uint32_t kClientDomain = 3;
    static constexpr std::uint32_t kOtherClientDomain = 4;

    void SetUp() override { test::isolate_domains(); }

    PublishedModel published(const std::string& name, const TinyModel& model)
    {
        const auto path = folder.write((name + std::to_string(files_++)).c_str(), model.file);
        return {name, ModelStore::open(path).value()};
    }
    std::unique_ptr<ServerThread> server_of(const std::string& name, const TinyModel& model,
                                            std::uint32_t domain = kServerDomain)
    {
        std::vector<PublishedModel> models;
        models.push_back(published(name, model));
        return std::make_unique<ServerThread>(domain, std::move(models), server_lines.log());
    }
    std::unique_ptr<DdsClient> client(std::uint32_t domain = kClientDomain)
    {
        auto created = DdsClient::create(domain, "test-" + std::to_string(domain), lines.log());
        EXPECT_TRUE(created) << created.error().text;
        return std::move(created).value();
    }

    /// Start of a served model.
    static ServedModel found(DdsClient& finder, const std::string& name = "tiny")
    {
        auto found = finder.find({name, std::nullopt}, kPatience);
        EXPECT_TRUE(found) << found.error().text;
        return std::move(found).value();
    }
    /// Creates a server of this model and a controller with its start.
    void connect(const TinyModel& model)
    {
        server = server_of("tiny", model);
        controller = client();
        served = found(*controller);
    }
    static bool polled_until(ChunkLink& link, PieceSink& sink, const std::function<bool()>& is_so)
    {
        return eventually(
            [&]
            {
                link.poll(sink);
                return is_so();
            });
    }

    TemporaryFolder folder;
    Lines lines;
    Lines server_lines;
    std::unique_ptr<ServerThread> server;
    std::unique_ptr<DdsClient> controller;
    ServedModel served; ///< Declared after the controller, whose link it has.

private:
    int files_{0};
};

std::vector<ContentKey> all_pieces(const TinyModel& model)
{
    std::vector<ContentKey> keys;
    for (std::uint32_t page = 0; page < model.index_pages.size(); ++page)
    {
        keys.push_back({ContentKind::index_page, page});
    }
    for (std::uint32_t chunk = 0; chunk < model.chunks.size(); ++chunk)
    {
        keys.push_back({ContentKind::chunk, chunk});
    }
    return keys;
}

void expect_whole_model(const Collector& got, const TinyModel& model)
{
    for (const ContentKey key : all_pieces(model))
    {
        const auto at = got.pieces.find({key.kind, key.number});
        ASSERT_NE(at, got.pieces.end()) << key.number;
        EXPECT_TRUE(std::ranges::equal(at->second, model.piece(key))) << key.number;
    }
}

TEST_F(Dds, a_late_joiner_gets_the_model_s_start_and_every_piece_that_it_asks_for)
{
    const TinyModel model = make_tiny_model({.records = 64 * 100});
    connect(model);
    EXPECT_TRUE(std::ranges::equal(served.header, model.header));
    EXPECT_TRUE(std::ranges::equal(served.base, model.base));
    EXPECT_EQ(served.hash, model_hash(model.header));
    Collector got;
    const auto keys = all_pieces(model);
    served.link->request(keys, 1);
    EXPECT_TRUE(polled_until(*served.link, got, [&] { return got.pieces.size() == keys.size(); }));
    expect_whole_model(got, model);
    EXPECT_EQ(got.count, keys.size());
    EXPECT_GT(served.link->bytes_received(), model.file.size() / 2);
}

TEST_F(Dds, many_models_start_at_once_and_a_base_mesh_of_several_parts_comes_whole)
{
    std::vector<TinyModel> models;
    std::vector<PublishedModel> published_models;
    std::vector<ModelSelector> selectors;
    for (std::uint32_t i = 0; i < 40; ++i)
    {
        models.push_back(make_tiny_model({.seed = i + 1, .base_faces = i == 7 ? 12'000U : 8U}));
        published_models.push_back(published("m" + std::to_string(i), models.back()));
        selectors.push_back({"m" + std::to_string(i), std::nullopt});
    }
    ASSERT_GT(models[7].base.size(), 2 * kPartBytes);
    ServerThread many(kServerDomain, std::move(published_models), server_lines.log());
    const auto sut = client();
    auto found = sut->find_headers(selectors, kPatience);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_TRUE(std::ranges::all_of(found.value(),
                                    [](const ServedModel& model) { return model.base.empty(); }));
    const std::uint64_t pieces = many.counters().pieces_sent;
    EXPECT_EQ(pieces, models.size()); // Their headers, and nothing else.
    EXPECT_FALSE(fetch_base_meshes(found.value(), kPatience));
    for (std::size_t i = 0; i < models.size(); ++i)
    {
        EXPECT_TRUE(std::ranges::equal(found.value()[i].header, models[i].header)) << i;
        EXPECT_TRUE(std::ranges::equal(found.value()[i].base, models[i].base)) << i;
        found.value()[i].link->request(all_pieces(models[i]), 1);
    }
    std::vector<Collector> got(models.size());
    EXPECT_TRUE(eventually(
        [&]
        {
            bool all = true;
            for (std::size_t i = 0; i < models.size(); ++i)
            {
                found.value()[i].link->poll(got[i]);
                all = all && got[i].pieces.size() == all_pieces(models[i]).size();
            }
            return all;
        }));
    for (std::size_t i = 0; i < models.size(); ++i)
    {
        expect_whole_model(got[i], models[i]);
    }
    EXPECT_EQ(many.subscribers().size(), 1U); // One for each controller and any request.
}

TEST_F(Dds, a_server_that_goes_in_the_middle_of_a_header_is_completed_by_another)
{
    const TinyModel model = make_tiny_model({});
    server = server_of("tiny", model);
    const auto sut = client();
    HeaderSearch search(sut->exchange(), sut->catalogue(), kTiny[0]);
    ASSERT_TRUE(eventually(
        [&]
        {
            sut->exchange().step();
            return search.step() == HeaderSearch::State::under_way;
        }));
    server.reset(); // The server was asked, and ended before an answer.
    const auto second = server_of("tiny", model, kOtherServerDomain);
    EXPECT_TRUE(eventually(
        [&]
        {
            sut->exchange().step();
            return search.step() == HeaderSearch::State::done;
        }));
    EXPECT_TRUE(std::ranges::equal(search.header(), model.header));
}

/// Counts the received parts of a base mesh.
struct PartCounter final : PieceReceiver
{
    explicit PartCounter(const ContentHash& model) : model_(model) {}
    [[nodiscard]] const ContentHash& model() const override { return model_; }
    void receive(std::uint64_t /*server_epoch*/, ContentKey key,
                 std::span<const std::byte> /*bytes*/) override
    {
        times[key.number] += key.kind == ContentKind::base ? 1 : 0;
    }
    std::map<std::uint32_t, int> times;

private:
    ContentHash model_;
};

TEST_F(Dds, what_came_of_a_base_mesh_before_its_server_went_is_not_asked_of_another)
{
    const TinyModel model = make_tiny_model({.base_faces = 12'000});
    server = server_of("tiny", model);
    const auto sut = client();
    PieceExchange& exchange = sut->exchange();
    auto found = sut->find_headers(kTiny, kPatience);
    ASSERT_TRUE(found) << found.error().text;
    ServedModel& base_less = found.value()[0];
    PartCounter counter(base_less.hash);
    exchange.add(counter);
    BaseFetch fetch(base_less);
    const std::vector<ContentKey> some{{ContentKind::base, 0}, {ContentKind::base, 1}};
    base_less.link->request(some, 0);
    ASSERT_TRUE(eventually(
        [&]
        {
            exchange.step();
            return counter.times[1] == 1;
        }));
    EXPECT_EQ(fetch.step(), BaseFetch::State::under_way);
    server.reset(); // The rest was also requested from it, but was not sent.
    const auto second = server_of("tiny", model, kOtherServerDomain);
    EXPECT_TRUE(eventually([&] { return fetch.step() == BaseFetch::State::done; }));
    EXPECT_TRUE(std::ranges::equal(base_less.base, model.base));
    EXPECT_EQ(counter.times[0], 1);
    EXPECT_EQ(counter.times[1], 1);
    EXPECT_GE(counter.times[2], 1);
    EXPECT_GE(second->counters().pieces_sent, 1U); // The rest of the base mesh.
    exchange.remove(counter);
}

TEST_F(Dds, a_model_that_is_announced_otherwise_than_it_is_is_refused_or_never_comes)
{
    connect(make_tiny_model({}));
    const auto fetch_with = [&](const std::function<void(Catalogue::Offer&)>& change)
    {
        Catalogue::Offer offer = *controller->catalogue().find(kTiny[0]);
        change(offer);
        return HeaderFetch(controller->exchange(), controller->catalogue(), offer);
    };
    HeaderFetch too_large = fetch_with([](Catalogue::Offer& offer)
                                       { offer.base_bytes = std::uint32_t{kMaxBaseBytes} + 1; });
    EXPECT_EQ(too_large.step(), HeaderFetch::State::refused);
    EXPECT_NE(too_large.objection().find("a base mesh of 1048577; at most"), std::string::npos)
        << too_large.objection();
    HeaderFetch other_base = fetch_with([](Catalogue::Offer& offer) { offer.base_bytes += 1; });
    ASSERT_TRUE(eventually(
        [&]
        {
            controller->exchange().step();
            return other_base.step() == HeaderFetch::State::refused;
        }));
    EXPECT_NE(other_base.objection().find("but its header states"), std::string::npos)
        << other_base.objection();
    // A part of another size than announced is skipped.
    HeaderFetch other_header = fetch_with([](Catalogue::Offer& offer) { offer.header_bytes -= 1; });
    for (int i = 0; i < 200; ++i)
    {
        controller->exchange().step();
        EXPECT_NE(other_header.step(), HeaderFetch::State::done);
        std::this_thread::sleep_for(1ms);
    }
}

TEST_F(Dds, two_controllers_get_what_each_asked_for_and_nothing_else)
{
    const TinyModel model = make_tiny_model({.records = 64 * 40});
    connect(model);
    const auto second = client(kOtherClientDomain);
    const ServedModel two = found(*second);
    EXPECT_TRUE(eventually([&] { return server->subscribers().size() == 2; }));
    std::vector<ContentKey> even;
    std::vector<ContentKey> odd;
    for (std::uint32_t chunk = 0; chunk < 40; ++chunk)
    {
        (chunk % 2 == 0 ? even : odd).push_back({ContentKind::chunk, chunk});
    }
    Collector got_one;
    Collector got_two;
    served.link->request(even, 1);
    two.link->request(odd, 1);
    EXPECT_TRUE(polled_until(*served.link, got_one, [&] { return got_one.count >= 20; }));
    EXPECT_TRUE(polled_until(*two.link, got_two, [&] { return got_two.count >= 20; }));
    EXPECT_EQ(got_one.pieces.size(), 20U);
    EXPECT_EQ(got_two.pieces.size(), 20U);
    for (const ContentKey key : even)
    {
        EXPECT_TRUE(got_one.pieces.contains({key.kind, key.number}));
        EXPECT_FALSE(got_two.pieces.contains({key.kind, key.number}));
    }
}

TEST_F(Dds, a_restarted_server_with_the_same_file_is_adopted_under_its_new_epoch)
{
    const TinyModel model = make_tiny_model({.records = 64 * 4});
    connect(model);
    ChunkLink& sut = *served.link;
    Collector got;
    server.reset();
    ASSERT_TRUE(polled_until(sut, got, [&] { return sut.state() == LinkState::server_gone; }));
    EXPECT_TRUE(lines.has("server of model 'tiny' disconnected"));
    const std::uint64_t session = sut.session();
    server = server_of("tiny", model);
    ASSERT_TRUE(polled_until(sut, got, [&] { return sut.state() == LinkState::connected; }));
    EXPECT_GT(sut.session(), session);
    EXPECT_TRUE(lines.has("model 'tiny' is served again"));
    // The new server may not know the client yet; requests are repeated.
    const auto keys = all_pieces(model);
    EXPECT_TRUE(eventually(
        [&]
        {
            sut.request(keys, 1);
            for (int i = 0; i < 50; ++i)
            {
                sut.poll(got);
                std::this_thread::sleep_for(1ms);
            }
            return got.pieces.size() == keys.size();
        }));
    expect_whole_model(got, model);
}

TEST_F(Dds, a_changed_file_under_the_same_name_does_not_replace_the_resident_one)
{
    const TinyModel model = make_tiny_model({});
    connect(model);
    ChunkLink& sut = *served.link;
    Collector got;
    server.reset();
    server = server_of("tiny", make_tiny_model({.seed = 99}));
    EXPECT_TRUE(polled_until(sut, got, [&] { return lines.has("with another hash"); }));
    EXPECT_EQ(sut.state(), LinkState::server_gone);
    EXPECT_EQ(got.count, 0U);
}

TEST_F(Dds, a_model_that_nobody_publishes_is_named_with_what_is_there_and_its_hash)
{
    const TinyModel model = make_tiny_model({});
    connect(model);
    EXPECT_TRUE(controller->find({"tiny", model_hash(model.header)}, kPatience));
    const auto refusal = [&](const ModelSelector& selector)
    { return controller->find(selector, 100ms).error().text; };
    const std::string absent = refusal({"absent", std::nullopt});
    EXPECT_TRUE(absent.starts_with("model 'absent' is not published on domain 3 (waited "))
        << absent;
    EXPECT_NE(absent.find("published there: tiny)"), std::string::npos) << absent;
    const std::string pinned = refusal({"tiny", ContentHash{1}});
    EXPECT_NE(
        pinned.find("published there: tiny, with hash " + hash_text(model_hash(model.header))),
        std::string::npos)
        << pinned;
}

TEST_F(Dds, where_nothing_is_published_the_likeliest_cause_is_named_first)
{
    const auto lonely = client();
    const std::string uri = std::getenv("CYCLONEDDS_URI"); // The domain is already joined.
    ::unsetenv("CYCLONEDDS_URI");
    const std::string absent = lonely->find({"absent", std::nullopt}, 100ms).error().text;
    ::setenv("CYCLONEDDS_URI", uri.c_str(), 1);
    EXPECT_TRUE(absent.starts_with("model 'absent' is not published on domain 3: CYCLONEDDS_URI is "
                                   "not set, so only this machine is reached"))
        << absent;
    EXPECT_NE(absent.find("published there: none)"), std::string::npos) << absent;
}

TEST(DdsDomains, are_known_by_the_ports_of_their_programs)
{
    const std::string sockets =
        "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt\n"
        "  10: 0100007F:1CF2 00000000:0000 07 00000000:00000000 00:00000000 00000000\n" // Port 7410
        "  11: 0100007F:1DEE 00000000:0000 07 00000000:00000000 00:00000000 00000000\n" // Port 7662
        "  12: 0100007F:1E00 00000000:0000 07 00000000:00000000 00:00000000 00000000\n" // Port 7680
        // Port 65429
        "  13: 0100007F:FF95 00000000:0000 07 00000000:00000000 00:00000000 00000000\n"
        "  14: 0100007F:0035 00000000:0000 07 00000000:00000000 00:00000000 00000000\n"
        "  15: garbage\n\n";
    EXPECT_EQ(domains_in(sockets), (std::set<std::uint32_t>{0, 1, 232}));
    EXPECT_TRUE(domains_in("").empty());
}

TEST_F(Dds, waiting_for_a_model_ends_when_the_caller_says_so)
{
    const auto sut = client();
    int asked = 0;
    EXPECT_FALSE(sut->find({"absent", std::nullopt}, kPatience, [&] { return ++asked < 3; }));
    EXPECT_EQ(asked, 3);
}

TEST_F(Dds, of_two_hashes_under_one_name_the_first_seen_is_used_or_the_one_that_is_asked_for)
{
    const TinyModel first = make_tiny_model({});
    const TinyModel second = make_tiny_model({.seed = 2});
    connect(first);
    const auto other = server_of("tiny", second, kOtherServerDomain);
    const auto pinned = controller->find({"tiny", model_hash(second.header)}, kPatience);
    ASSERT_TRUE(pinned) << pinned.error().text;
    EXPECT_TRUE(std::ranges::equal(pinned.value().header, second.header));
    EXPECT_EQ(found(*controller).hash, model_hash(first.header));
}

TEST_F(Dds, controllers_of_one_name_are_served_each_and_removed_when_they_leave)
{
    connect(make_tiny_model({}));
    ASSERT_TRUE(eventually([&] { return server->subscribers().size() == 1; }));
    EXPECT_EQ(server->subscribers()[0].controller, "test-3");
    EXPECT_TRUE(server_lines.has("controller test-3 subscribed"));
    EXPECT_FALSE(server_lines.has("another controller"));
    {
        const auto second = DdsClient::create(kOtherClientDomain, "test-3", lines.log());
        ASSERT_TRUE(second) << second.error().text;
        const ServedModel model = found(*second.value());
        EXPECT_TRUE(
            server_lines.has("controller test-3 subscribed; another controller has this name\n"));
        EXPECT_EQ(server->subscribers().size(), 2U);
    }
    EXPECT_TRUE(eventually([&] { return server->subscribers().size() == 1; }));
    served.link.reset();
    controller.reset();
    EXPECT_TRUE(eventually([&] { return server->subscribers().empty(); }));
    EXPECT_TRUE(server_lines.has("controller test-3 left ("));
}

TEST_F(Dds, what_the_model_does_not_have_is_refused_and_the_rest_is_served)
{
    const TinyModel model = make_tiny_model({});
    connect(model);
    const std::vector<ContentKey> keys{{ContentKind::chunk, 9'999},
                                       {ContentKind::base, 9},
                                       {ContentKind::header, 9},
                                       {static_cast<ContentKind>(77), 0},
                                       {ContentKind::chunk, 1}};
    served.link->request(keys, 1);
    Collector got;
    EXPECT_TRUE(polled_until(*served.link, got, [&] { return got.count == 1; }));
    EXPECT_TRUE(got.pieces.contains({ContentKind::chunk, 1}));
    EXPECT_TRUE(eventually([&] { return server->counters().requests_refused == 4; }));
}

TEST_F(Dds, a_file_cut_while_it_is_served_costs_its_end_and_not_the_server)
{
    const TinyModel model = make_tiny_model({});
    const auto path = folder.write("cut.spm", model.file);
    std::vector<PublishedModel> models;
    models.push_back({"cut", ModelStore::open(path).value()});
    const ServerThread cut_server(kServerDomain, std::move(models), server_lines.log());
    const auto sut = client();
    const ServedModel cut = found(*sut, "cut");
    std::filesystem::resize_file(path, model.file.size() - 5);
    const std::vector<ContentKey> keys{{ContentKind::chunk, 3}, {ContentKind::chunk, 0}};
    cut.link->request(keys, 1);
    Collector got;
    EXPECT_TRUE(polled_until(*cut.link, got, [&] { return got.count == 1; }));
    EXPECT_TRUE(got.pieces.contains({ContentKind::chunk, 0}));
    EXPECT_TRUE(server_lines.has("cut.spm: chunk 3 at offset "));
}

TEST_F(Dds, a_domain_that_cannot_be_joined_is_refused_in_one_printable_line)
{
    EXPECT_EQ(Domain::join(233).error().text, "DDS domain 233 is not in 0 to 232");
    ::setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><Nonsense/></Domain></CycloneDDS>", 1);
    const auto refused = Domain::join(5);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text.find('\n'), std::string::npos);
    EXPECT_NE(refused.error().text.find("DDS domain 5 cannot be joined: "), std::string::npos);
    EXPECT_NE(refused.error().text.find("Nonsense"), std::string::npos) << refused.error().text;
    ::setenv("CYCLONEDDS_URI",
             "<CycloneDDS><Domain><Tracing><Verbosity>\x1b[31mred</Verbosity></Tracing></Domain>"
             "</CycloneDDS>",
             1);
    const std::string quoted = Domain::join(5).error().text;
    EXPECT_NE(quoted.find("[31mred"), std::string::npos) << quoted;
    EXPECT_EQ(quoted.find('\x1b'), std::string::npos);
}

TEST_F(Dds, a_domain_whose_ports_others_have_is_refused_with_their_numbers)
{
    ::unsetenv("CYCLONEDDS_URI");
    std::vector<int> sockets;
    for (std::uint16_t port = 64'910; port < 64'930; ++port)
    {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        sockets.push_back(::socket(AF_INET, SOCK_DGRAM, 0));
        // A failure means that the port is already in use.
        static_cast<void>(
            ::bind(sockets.back(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)));
    }
    const auto refused = []
    {
        [[maybe_unused]] const CycloneLosesMemory here;
        return Domain::join(230);
    }();
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("UDP ports 64910 to 64929"), std::string::npos)
        << refused.error().text;
    std::ranges::for_each(sockets, ::close);
    EXPECT_TRUE(Domain::join(230));
}

TEST_F(Dds, without_a_configuration_of_the_user_a_process_joins_as_server_and_controller)
{
    ::unsetenv("CYCLONEDDS_URI");
    std::vector<Domain> domains; // A server first, and then a controller.
    for (const Party party : {Party::server, Party::controller, Party::server})
    {
        auto joined = Domain::join(231, party);
        ASSERT_TRUE(joined) << joined.error().text;
        domains.push_back(std::move(joined).value());
    }
}

TEST_F(Dds, without_a_configuration_of_the_user_nothing_from_outside_the_machine_is_taken)
{
    ::unsetenv("CYCLONEDDS_URI");
    // Socket of another program, which stays unchanged.
    const int other = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in everywhere{};
    everywhere.sin_family = AF_INET;
    ASSERT_EQ(::bind(other, reinterpret_cast<sockaddr*>(&everywhere), sizeof(everywhere)), 0);
    const auto before = devices_of_open_sockets();
    for (const Party party : {Party::server, Party::controller})
    {
        const auto sut = Domain::join(party == Party::server ? 228 : 229, party);
        ASSERT_TRUE(sut) << sut.error().text;
        const auto open = devices_of_open_sockets();
        EXPECT_GT(open.size(), before.size());
        EXPECT_EQ(std::ranges::count(open, "lo") - std::ranges::count(before, "lo"),
                  std::ssize(open) - std::ssize(before));
    }
    ::close(other);
}

/// spm_publish, killed at the end.
struct Program
{
    explicit Program(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), TACTUS_SPM_PUBLISH);
        std::vector<char*> pointers;
        for (std::string& argument : arguments)
        {
            pointers.push_back(argument.data());
        }
        pointers.push_back(nullptr);
        EXPECT_EQ(::posix_spawn(&pid_, pointers[0], nullptr, nullptr, pointers.data(), environ), 0);
    }
    ~Program()
    {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

private:
    pid_t pid_{0};
};

/// Controllers without a user's configuration have no known ports.
TEST_F(Dds, a_controller_finds_a_server_that_starts_after_it_and_keeps_one_of_its_process_out)
{
    ::unsetenv("CYCLONEDDS_URI");
    const std::uint32_t domain = 200 + static_cast<std::uint32_t>(::getpid()) % 30;
    auto early = DdsClient::create(domain, "early", {});
    ASSERT_TRUE(early) << early.error().text;
    const auto server_beside = DdsServer::create(domain, {}, {});
    ASSERT_FALSE(server_beside);
    EXPECT_NE(server_beside.error().text.find("its server must join first"), std::string::npos);
    const std::string path = folder.write("tiny.spm", make_tiny_model({}).file).string();
    const Program publisher({path, "--domain", std::to_string(domain)});
    const auto found = early.value()->find({"tiny", std::nullopt}, kPatience);
    EXPECT_TRUE(found) << found.error().text;
}

TEST_F(Dds,
       spm_publish_looks_for_other_servers_so_a_process_with_one_finds_it_whether_it_looks_or_not)
{
    ::unsetenv("CYCLONEDDS_URI");
    const std::uint32_t domain = 200 + static_cast<std::uint32_t>(::getpid()) % 30;
    const std::string path = folder.write("tiny.spm", make_tiny_model({}).file).string();
    const Program publisher({path, "--domain", std::to_string(domain)});
    {
        const auto alone = Domain::join(domain, Party::server);
        ASSERT_TRUE(alone) << alone.error().text;
        const auto beside = DdsClient::create(domain, "beside", {});
        ASSERT_TRUE(beside) << beside.error().text;
        const auto found = beside.value()->find({"tiny", std::nullopt}, kPatience);
        EXPECT_TRUE(found) << found.error().text;
    }
    const auto joined = Domain::join(domain, Party::both);
    ASSERT_TRUE(joined) << joined.error().text;
    const auto sut = DdsClient::create(domain, "both", {});
    ASSERT_TRUE(sut) << sut.error().text;
    const auto found = sut.value()->find({"tiny", std::nullopt}, kPatience);
    EXPECT_TRUE(found) << found.error().text;
}

} // namespace
} // namespace tactus::dds
