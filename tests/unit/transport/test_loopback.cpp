// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/loopback/loopback_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace tactus
{
namespace
{

/// Answers at once with four bytes: the piece's number.
class Echo final : public ChunkLink
{
public:
    void request(std::span<const ContentKey> keys, std::uint32_t /*generation*/) override
    {
        keys_.insert(keys_.end(), keys.begin(), keys.end());
    }
    void poll(PieceSink& sink) override
    {
        for (const ContentKey key : keys_)
        {
            sink.receive(key, std::as_bytes(std::span(&key.number, 1)));
        }
        keys_.clear();
    }
    [[nodiscard]] LinkState state() const override { return LinkState::connected; }
    [[nodiscard]] std::uint64_t session() const override { return 1; }
    [[nodiscard]] std::uint64_t bytes_received() const override { return 0; }

private:
    std::vector<ContentKey> keys_;
};

class Record final : public PieceSink
{
public:
    void receive(ContentKey key, std::span<const std::byte> bytes) override
    {
        numbers.push_back(key.number);
        contents.emplace_back(bytes.begin(), bytes.end());
    }
    std::vector<std::uint32_t> numbers;
    std::vector<std::vector<std::byte>> contents;
};

std::vector<std::uint32_t> run(const LoopbackFaults& faults, std::uint32_t pieces, int polls)
{
    Echo echo;
    LoopbackLink sut(echo, faults);
    Record record;
    for (std::uint32_t number = 0; number < pieces; ++number)
    {
        const ContentKey key{ContentKind::chunk, number};
        sut.request({&key, 1}, 0);
    }
    for (int i = 0; i < polls; ++i)
    {
        sut.poll(record);
    }
    return record.numbers;
}

TEST(LoopbackLink, passes_everything_in_order_without_faults)
{
    const auto numbers = run({}, 50, 1);
    ASSERT_EQ(numbers.size(), 50U);
    EXPECT_TRUE(std::ranges::is_sorted(numbers));
}

TEST(LoopbackLink, delays_by_polls_and_reorders)
{
    EXPECT_TRUE(run({.delay_polls_min = 5, .delay_polls_max = 5}, 20, 5).empty());
    EXPECT_EQ(run({.delay_polls_min = 5, .delay_polls_max = 5}, 20, 6).size(), 20U);
    const auto numbers = run({.delay_polls_min = 0, .delay_polls_max = 9}, 200, 10);
    EXPECT_EQ(numbers.size(), 200U);
    EXPECT_FALSE(std::ranges::is_sorted(numbers));
}

TEST(LoopbackLink, loses_and_repeats_the_stated_share)
{
    const std::size_t kept = run({.loss = 0.25}, 8'000, 1).size(); // Requests are lost as well.
    EXPECT_NEAR(static_cast<double>(kept), 8'000 * 0.75 * 0.75, 200.0);
    const std::size_t doubled = run({.duplicates = 0.5}, 8'000, 1).size();
    EXPECT_NEAR(static_cast<double>(doubled), 12'000.0, 200.0);
}

TEST(LoopbackLink, does_the_same_for_the_same_seed)
{
    const LoopbackFaults faults{.seed = 5, .loss = 0.3, .delay_polls_max = 4};
    EXPECT_EQ(run(faults, 300, 5), run(faults, 300, 5));
    LoopbackFaults other = faults;
    other.seed = 6;
    EXPECT_NE(run(faults, 300, 5), run(other, 300, 5));
}

} // namespace
} // namespace tactus
