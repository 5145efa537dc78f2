// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/loopback_link.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/base_fetch.hpp"
#include "transport/store/store_link.hpp"
#include "transport/waiting_times.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

namespace tactus::test
{
namespace
{

constexpr std::chrono::seconds kPatience{60};

/// Link that owns the one that it disturbs.
struct FaultyLink final : ChunkLink
{
    FaultyLink(std::unique_ptr<ChunkLink> wrapped, const LoopbackFaults& faults)
        : wrapped_(std::move(wrapped)), loopback_(*wrapped_, faults)
    {
    }
    void request(std::span<const ContentKey> keys, std::uint32_t generation) override
    {
        asked += keys.size();
        loopback_.request(keys, generation);
    }
    void poll(PieceSink& sink) override { loopback_.poll(sink); }
    [[nodiscard]] LinkState state() const override { return loopback_.state(); }
    [[nodiscard]] std::uint64_t session() const override { return loopback_.session(); }
    [[nodiscard]] std::uint64_t bytes_received() const override
    {
        return loopback_.bytes_received();
    }
    void lose_server() { loopback_.lose_server(); }
    void regain_server() { loopback_.regain_server(); }

    std::size_t asked{0};

private:
    std::unique_ptr<ChunkLink> wrapped_;
    LoopbackLink loopback_;
};

/// Model with a base mesh of three parts that is still to be loaded.
struct Waiting
{
    explicit Waiting(const LoopbackFaults& faults = {})
        : model(make_tiny_model({.base_faces = 12'000}))
    {
        const auto path = folder.write("tiny.spm", model.file);
        served.push_back(serve_from_file(path, "tiny", {}).value());
        served[0].base.clear();
        auto faulty = std::make_unique<FaultyLink>(std::move(served[0].link), faults);
        link = faulty.get();
        served[0].link = std::move(faulty);
    }
    [[nodiscard]] bool is_whole() const { return std::ranges::equal(served[0].base, model.base); }

    TemporaryFolder folder;
    TinyModel model;
    std::vector<ServedModel> served;
    FaultyLink* link{nullptr};
};

TEST(BaseFetch, asks_for_each_part_once_and_has_the_base_mesh)
{
    Waiting sut;
    EXPECT_FALSE(fetch_base_meshes(sut.served, kPatience));
    EXPECT_TRUE(sut.is_whole());
    EXPECT_EQ(sut.link->asked, parts_of(sut.model.base.size()));
    EXPECT_FALSE(fetch_base_meshes(sut.served, kPatience)); // The base mesh is resident.
    EXPECT_EQ(sut.link->asked, parts_of(sut.model.base.size()));
}

TEST(BaseFetch, asks_again_for_what_is_lost_and_drops_what_comes_twice)
{
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
    {
        Waiting sut({.seed = seed, .loss = 0.6, .duplicates = 0.5, .delay_polls_max = 5});
        EXPECT_FALSE(fetch_base_meshes(sut.served, kPatience)) << seed;
        EXPECT_TRUE(sut.is_whole()) << seed;
    }
}

TEST(BaseFetch, refuses_a_base_mesh_that_the_header_does_not_name)
{
    Waiting sut({.damage = 1.0});
    const auto refusal = fetch_base_meshes(sut.served, kPatience);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->text,
              "model 'tiny' has a base mesh that does not match the hash in its header");
    EXPECT_TRUE(sut.served[0].base.empty());
}

TEST(BaseFetch, waits_for_a_server_and_asks_the_next_one)
{
    Waiting sut({.delay_polls_min = 3, .delay_polls_max = 3});
    BaseFetch fetch(sut.served[0]);
    EXPECT_EQ(fetch.step(), BaseFetch::State::under_way);
    sut.link->lose_server(); // Drops everything in transit.
    for (int i = 0; i < 20; ++i)
    {
        EXPECT_EQ(fetch.step(), BaseFetch::State::under_way);
    }
    EXPECT_EQ(sut.link->asked, parts_of(sut.model.base.size()));
    sut.link->regain_server();
    for (int i = 0; i < 1'000 && fetch.step() != BaseFetch::State::done; ++i)
    {
    }
    EXPECT_TRUE(sut.is_whole());
    EXPECT_GE(sut.link->asked, 2 * parts_of(sut.model.base.size()));
}

TEST(BaseFetch, ends_when_it_may_not_go_on_and_says_what_is_missing)
{
    Waiting sut;
    sut.link->lose_server();
    int rounds = 0;
    const auto refusal = fetch_base_meshes(sut.served, kPatience, [&] { return ++rounds < 3; });
    ASSERT_TRUE(refusal);
    EXPECT_TRUE(refusal->text.starts_with("the base mesh of model 'tiny' did not arrive (waited "))
        << refusal->text;
    EXPECT_TRUE(fetch_base_meshes(sut.served, std::chrono::milliseconds(0)));
}

constexpr std::int64_t kMillisecond_ns = 1'000'000;

} // namespace

TEST(WaitingTimes, without_any_everything_is_zero)
{
    const WaitingTimes sut;
    EXPECT_EQ(sut.total(), 0U);
    EXPECT_EQ(sut.quantile_ms(0.5), 0.0);
    EXPECT_EQ(sut.longest_ms(), 0.0);
}

TEST(WaitingTimes, a_quantile_is_at_most_a_step_above_the_truth)
{
    WaitingTimes sut;
    for (int i = 1; i <= 100; ++i)
    {
        sut.add(i * kMillisecond_ns);
    }
    EXPECT_GE(sut.quantile_ms(0.5), 50.0);
    EXPECT_LE(sut.quantile_ms(0.5), 50.25);
    EXPECT_GE(sut.quantile_ms(0.99), 99.0);
    EXPECT_LE(sut.quantile_ms(0.99), 99.25);
    EXPECT_EQ(sut.quantile_ms(1.0), 100.0) << "no more than the longest";
    EXPECT_EQ(sut.total(), 100U);
}

TEST(WaitingTimes, beyond_the_steps_the_longest_stands_for_all)
{
    WaitingTimes sut;
    sut.add(2'000 * kMillisecond_ns);
    sut.add(700 * kMillisecond_ns);
    EXPECT_EQ(sut.quantile_ms(0.5), 2'000.0);
    EXPECT_EQ(sut.longest_ms(), 2'000.0);
}

TEST(WaitingTimes, a_clock_that_stepped_back_counts_as_no_time)
{
    WaitingTimes sut;
    sut.add(-5);
    EXPECT_EQ(sut.total(), 1U);
    EXPECT_EQ(sut.longest_ms(), 0.0);
}

TEST(WaitingTimes, those_of_two_models_add_up)
{
    WaitingTimes sut;
    sut.add(kMillisecond_ns);
    WaitingTimes other;
    other.add(9 * kMillisecond_ns);

    sut += other;

    EXPECT_EQ(sut.total(), 2U);
    EXPECT_EQ(sut.sum_ns(), 10 * kMillisecond_ns);
    EXPECT_EQ(sut.quantile_ms(1.0), 9.0);
    EXPECT_LE(sut.quantile_ms(0.5), 1.25);
}
} // namespace tactus::test
