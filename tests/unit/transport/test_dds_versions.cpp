// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Others on the wire that speak another version of the protocol: passed over, in one line, and
/// nothing that they say touches what speaks ours.

#include "tests/shared/count_of.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/dds_host.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <thread>
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

/// What a program waits for something that must not come.
constexpr auto kMoment = 300ms;
constexpr std::uint32_t kOtherVersion = kProtocolVersion + 1;

class Nobody final : public PieceSink
{
public:
    void receive(ContentKey /*key*/, std::span<const std::byte> /*bytes*/) override { ++count; }
    std::size_t count{0};
};

/// Host, controller and stranger as three domains of this process that meet on loopback; host and
/// controller take turns on one thread.
class DdsVersions : public ::testing::Test
{
protected:
    static constexpr std::uint32_t kHostDomain = 1;
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
    void start_host()
    {
        std::vector<PublishedModel> models;
        models.push_back({"tiny", ModelStore::open(folder.write("tiny", model.file)).value()});
        auto created = DdsHost::create(kHostDomain, std::move(models), log_into(host_lines));
        ASSERT_TRUE(created) << created.error().text;
        host = std::move(created).value();
    }
    /// Both step until it is so or the time is over; whether it is so.
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
    void step()
    {
        if (host)
        {
            host->step();
        }
        if (link)
        {
            link->poll(got);
        }
    }
    /// Our controller with the model of our host.
    void connect()
    {
        auto found = client->find({"tiny", std::nullopt}, kPatience,
                                  [&]
                                  {
                                      step();
                                      return true;
                                  });
        ASSERT_TRUE(found) << found.error().text;
        link = std::move(found.value().link);
        ASSERT_TRUE(step_until([&] { return host->subscribers().size() == 1; }));
    }

    /// A host's announcement; the writer is to be kept as long as it is to last.
    [[nodiscard]] Endpoint announce(std::uint64_t epoch, std::uint32_t version) const
    {
        Endpoint writer = make_writer(stranger, Topic::catalogue, "").value();
        tactus_v1_CatalogueEntry entry = {};
        std::strcpy(static_cast<char*>(entry.name), "tiny");
        entry.host_epoch = epoch;
        entry.protocol_version = version;
        const ContentHash hash = model_hash(model.header);
        std::memcpy(entry.model_hash, hash.data(), hash.size());
        EXPECT_EQ(dds_write(writer.handle, &entry), DDS_RETCODE_OK);
        return writer;
    }
    [[nodiscard]] tactus_v1_Wanted request(std::uint64_t epoch, std::uint32_t version) const
    {
        tactus_v1_Wanted wanted = {};
        wanted.controller[0] = 77;
        const ContentHash hash = model_hash(model.header);
        std::memcpy(wanted.model_hash, hash.data(), hash.size());
        std::strcpy(static_cast<char*>(wanted.controller_name), "strange\n\x1b[31m");
        wanted.protocol_version = version;
        wanted.host_epoch = epoch;
        wanted.granted = kCreditPieces;
        return wanted;
    }
    /// Of the only host that the stranger sees.
    [[nodiscard]] std::uint64_t host_epoch()
    {
        const std::string everywhere;
        const Endpoint reader = make_reader(stranger, Topic::catalogue, {&everywhere, 1}).value();
        std::uint64_t epoch = 0;
        EXPECT_TRUE(step_until(
            [&]
            {
                void* sample = nullptr;
                dds_sample_info_t info = {};
                if (dds_take(reader.handle, &sample, &info, 1, 1) == 1)
                {
                    epoch = static_cast<const tactus_v1_CatalogueEntry*>(sample)->host_epoch;
                    dds_return_loan(reader.handle, &sample, 1);
                }
                return epoch != 0;
            }));
        return epoch;
    }

    TinyModel model{make_tiny_model({})};
    TemporaryFolder folder;
    std::string lines;
    std::string host_lines;
    Domain stranger;
    std::unique_ptr<DdsHost> host;
    std::unique_ptr<DdsClient> client;
    std::unique_ptr<ChunkLink> link;
    Nobody got;
};

TEST_F(DdsVersions, a_host_of_another_version_is_reported_and_passed_over)
{
    const Endpoint foreign = announce(5, kOtherVersion);
    const auto alone = client->find({"tiny", std::nullopt}, 1s);
    ASSERT_FALSE(alone);
    EXPECT_NE(alone.error().text.find("is not published"), std::string::npos) << alone.error().text;
    const std::string line =
        "model 'tiny' is published with protocol version 2; this build speaks 1";
    EXPECT_EQ(test::count_of(lines, line), 1U) << lines;
    ASSERT_NO_FATAL_FAILURE(start_host());
    ASSERT_NO_FATAL_FAILURE(connect());
    const std::vector<ContentKey> keys{{ContentKind::chunk, 0}};
    link->request(keys, 1);
    EXPECT_TRUE(step_until([&] { return got.count == 1; }));
}

TEST_F(DdsVersions, when_the_host_goes_one_of_another_version_is_no_successor)
{
    ASSERT_NO_FATAL_FAILURE(start_host());
    ASSERT_NO_FATAL_FAILURE(connect());
    const Endpoint foreign = announce(5, kOtherVersion);
    ASSERT_TRUE(step_until([&] { return lines.find("protocol version 2") != std::string::npos; }));
    EXPECT_EQ(link->state(), LinkState::connected);
    host.reset();
    ASSERT_TRUE(step_until([&] { return link->state() == LinkState::host_gone; }));
    EXPECT_FALSE(step_until([&] { return link->state() == LinkState::connected; }, kMoment));
    const Endpoint same = announce(6, kProtocolVersion); // The same entry of our version is one.
    EXPECT_TRUE(step_until([&] { return link->state() == LinkState::connected; }));
}

TEST_F(DdsVersions, a_controller_of_another_version_is_refused_and_named_and_ours_is_served)
{
    ASSERT_NO_FATAL_FAILURE(start_host());
    ASSERT_NO_FATAL_FAILURE(connect());
    const std::uint64_t epoch = host_epoch();
    const Endpoint writer =
        make_writer(stranger, Topic::wanted, model_partition(model_hash(model.header))).value();
    tactus_v1_Wanted wanted = request(epoch, kOtherVersion);
    ASSERT_TRUE(step_until([&] { return is_matched(writer); }));
    ASSERT_EQ(dds_write(writer.handle, &wanted), DDS_RETCODE_OK);
    ASSERT_TRUE(step_until([&] { return host->counters().requests_refused == 1; }));
    EXPECT_EQ(host->subscribers().size(), 1U);
    EXPECT_EQ(test::count_of(host_lines, "it speaks protocol version 2, this build 1"), 1U)
        << host_lines;
    EXPECT_EQ(host_lines.find('\x1b'), std::string::npos);
    EXPECT_EQ(std::ranges::count(host_lines, '\n'), 2) << host_lines; // And that ours subscribed.
    const std::vector<ContentKey> keys{{ContentKind::chunk, 0}};
    link->request(keys, 1);
    EXPECT_TRUE(step_until([&] { return got.count == 1; }));

    wanted = request(epoch, kProtocolVersion); // The same request of our version is served.
    ASSERT_EQ(dds_write(writer.handle, &wanted), DDS_RETCODE_OK);
    EXPECT_TRUE(step_until([&] { return host->subscribers().size() == 2; }));
    EXPECT_EQ(host->counters().requests_refused, 1U);
}

} // namespace
} // namespace tactus::dds
