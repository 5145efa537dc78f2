// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/transport/dds_rig.hpp"
#include "transport/dds/handshake_watch.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/subscription.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/writer_lanes.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "tactus.h"

namespace tactus::dds
{
namespace
{

using test::eventually;

struct Lanes : ::testing::Test
{
    static constexpr const char* kPartition = "lanes";

    void SetUp() override
    {
        test::isolate_domains();
        server_.emplace(Domain::join(1).value());
        client_.emplace(Domain::join(2).value());
    }
    Endpoint reader(const std::string& partition)
    {
        return make_reader(*client_, Topic::chunks, partition).value();
    }
    /// Takes samples by their count and writer.
    void take_from(const Endpoint& reader)
    {
        take_each<tactus_v5_Pieces>(
            reader.handle, 100,
            [this](const tactus_v5_Pieces& sample, const dds_sample_info_t& info)
            {
                if (info.valid_data)
                {
                    counts_.insert(sample.sent);
                    writers_.insert(info.publication_handle);
                }
            });
    }

    std::optional<Domain> server_;
    std::optional<Domain> client_;
    std::set<std::uint64_t> counts_;
    std::set<dds_instance_handle_t> writers_;
};

TEST_F(Lanes, without_a_reader_are_not_matched_and_write_to_nobody)
{
    auto sut = WriterLanes::create(*server_, Topic::chunks, kPartition).value();
    tactus_v5_Pieces sample = {};

    EXPECT_FALSE(sut.is_matched());
    for (std::uint64_t i = 0; i < 10 * WriterLanes::kSamplesALane; ++i)
    {
        EXPECT_TRUE(sut.write(&sample, &sample));
    }
    EXPECT_EQ(sut.open(), 1U); // The next one waits for its reader's answer.
}

TEST_F(Lanes, join_one_by_one_and_take_turns_and_everything_comes)
{
    auto sut = WriterLanes::create(*server_, Topic::chunks, kPartition).value();
    const Endpoint in = reader(kPartition);
    ASSERT_TRUE(eventually([&] { return sut.is_matched() && has_publisher(in); }));
    EXPECT_EQ(sut.open(), 1U);
    std::uint64_t sent = 0;
    const auto write = [&]
    {
        tactus_v5_Pieces sample = {};
        // Otherwise the reader would refuse it.
        sample.server_epoch = server_->participants().own_epoch();
        tactus_v5_Pieces probe = sample;
        sample.sent = ++sent;
        EXPECT_TRUE(sut.write(&sample, &probe));
        take_from(in);
    };
    EXPECT_TRUE(eventually(
        [&]
        {
            write();
            return sut.open() == WriterLanes::kLanes;
        }));
    EXPECT_GE(sent, (WriterLanes::kLanes - 1) * WriterLanes::kSamplesALane);
    writers_.clear();
    for (std::size_t i = 0; i < 2 * WriterLanes::kLanes; ++i)
    {
        write();
    }
    EXPECT_TRUE(eventually(
        [&]
        {
            take_from(in);
            return counts_.size() == sent + 1; // Includes the probes' 0.
        }));
    EXPECT_EQ(*counts_.rbegin(), sent);
    EXPECT_EQ(writers_.size(), WriterLanes::kLanes);
}

TEST_F(Lanes, an_older_request_that_comes_late_takes_no_credit_back)
{
    PieceRequests sut(0);
    sut.add({0, {ContentKind::chunk, 0}}, 1);
    EXPECT_FALSE(sut.has_work()); // Nothing is granted yet.

    sut.set_credit({0, 128, 0});
    EXPECT_TRUE(sut.has_work());
    sut.set_credit({0, 0, 0});
    EXPECT_TRUE(sut.has_work());
}

TEST_F(Lanes, lose_what_a_reader_that_does_not_answer_would_make_them_keep)
{
    auto sut = WriterLanes::create(*server_, Topic::chunks, kPartition).value();
    tactus_v5_Pieces sample = {};
    constexpr std::size_t bytes = WriterLanes::kUnackedMax / 2 + 1;
    for (int i = 0; i < 10; ++i)
    {
        EXPECT_TRUE(sut.write(&sample, &sample, bytes)) << "without a reader all is answered";
    }
    const Endpoint in = reader(kPartition);
    ASSERT_TRUE(eventually([&] { return sut.is_matched(); }));
    bool is_full = false;
    for (int i = 0; i < 100'000 && !is_full; ++i) // The reader's answers take a moment.
    {
        is_full = !sut.write(&sample, &sample, bytes);
    }
    EXPECT_TRUE(is_full);
    EXPECT_TRUE(eventually([&] { return sut.write(&sample, &sample, bytes); }));
}

TEST_F(Lanes, that_are_renewed_are_one_other_writer_and_not_at_once_again)
{
    auto sut = WriterLanes::create(*server_, Topic::chunks, kPartition).value();
    const Endpoint in = reader(kPartition);
    tactus_v5_Pieces sample = {};
    sample.server_epoch = server_->participants().own_epoch();
    const auto comes = [&](std::uint64_t count)
    {
        sample.sent = count;
        return eventually([&] { return sut.is_matched(); }) && sut.write(&sample, &sample) &&
               eventually(
                   [&]
                   {
                       take_from(in);
                       return counts_.contains(count);
                   });
    };
    ASSERT_TRUE(comes(1));
    const auto now = Backoff::Clock::now();
    EXPECT_NE(sut.try_renew(now), nullptr);
    EXPECT_EQ(sut.try_renew(now), nullptr);
    ASSERT_TRUE(comes(2));
    EXPECT_EQ(writers_.size(), 2U);
    EXPECT_EQ(sut.open(), 1U);
    EXPECT_NE(sut.try_renew(now + std::chrono::seconds(1)), nullptr);
    EXPECT_EQ(sut.try_renew(now + std::chrono::seconds(2)), nullptr) << "less often each time";
}

TEST_F(Lanes, are_renewed_where_pieces_stay_away_for_300_ms)
{
    auto sut = Subscription::create(*server_, ControllerId{1}, "controller", 100).value();
    const auto start = Backoff::Clock::now();
    sut.requests().set_credit({100, 228, 80}); // Older than samples sent since.
    EXPECT_EQ(sut.try_heal(start), nullptr);
    EXPECT_EQ(sut.try_heal(start + std::chrono::seconds(2)), nullptr);
    sut.requests().set_credit({100, 228, 70});
    EXPECT_EQ(sut.try_heal(start + std::chrono::milliseconds(2'200)), nullptr);
    sut.requests().set_credit({100, 228, 80}); // They arrived late.
    EXPECT_EQ(sut.try_heal(start + std::chrono::milliseconds(2'400)), nullptr);
    sut.requests().set_credit({100, 228, 70});
    EXPECT_NE(sut.try_heal(start + std::chrono::milliseconds(2'800)), nullptr);
    EXPECT_EQ(sut.try_heal(start + std::chrono::seconds(10)), nullptr) << "these were given up";
}

using std::chrono::seconds;

/// The silences, by their start and length in seconds, of a watch that is stepped once a second
/// from `begin` to `end`.
std::vector<std::pair<int, int>> silences(HandshakeWatch& watch, int begin, int end,
                                          bool is_connected, bool is_discovered)
{
    std::vector<std::pair<int, int>> result;
    for (int second = begin; second < end; ++second)
    {
        const auto now = HandshakeWatch::Clock::time_point(seconds(1'000 + second));
        if (const auto silence = watch.step(now, is_connected, is_discovered))
        {
            result.emplace_back(second, static_cast<int>(silence->count()));
        }
    }
    return result;
}

using Silences = std::vector<std::pair<int, int>>;

TEST(HandshakeWatch, is_silent_after_its_patience_with_growing_pauses)
{
    HandshakeWatch watch;
    EXPECT_EQ(
        silences(watch, 0, 200, false, true),
        (Silences{{5, 3}, {13, 6}, {24, 9}, {38, 12}, {55, 12}, {72, 12}, {104, 12}, {164, 12}}));
}

TEST(HandshakeWatch, has_no_cause_without_a_server_or_with_a_connected_one)
{
    HandshakeWatch watch;
    EXPECT_EQ(silences(watch, 0, 100, false, false), Silences{});
    EXPECT_EQ(silences(watch, 100, 200, true, false), Silences{});
}

TEST(HandshakeWatch, waits_again_after_a_server_was_gone)
{
    HandshakeWatch watch;
    EXPECT_EQ(silences(watch, 0, 5, false, true), Silences{});
    EXPECT_EQ(silences(watch, 5, 6, false, false), Silences{});
    EXPECT_EQ(silences(watch, 6, 12, false, true), (Silences{{11, 3}}));
    // The silence itself ends the discovery; the pauses and lengths continue to grow.
    EXPECT_EQ(silences(watch, 12, 15, false, false), Silences{});
    EXPECT_EQ(silences(watch, 15, 24, false, true), (Silences{{20, 6}}));
}

TEST(HandshakeWatch, forgets_earlier_silences_with_a_connection)
{
    HandshakeWatch watch;
    EXPECT_EQ(silences(watch, 0, 20, false, true), (Silences{{5, 3}, {13, 6}}));
    EXPECT_EQ(silences(watch, 20, 21, true, false), Silences{});
    EXPECT_EQ(silences(watch, 21, 30, false, true), (Silences{{26, 3}}));
}

} // namespace
} // namespace tactus::dds
