// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/interleave/choices.hpp"
#include "tests/interleave/queue_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <iostream>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Life of pages between the two threads: the product's loader, linker, cache and page table,
/// driven through every sequence of verbs up to a length (see QueueWorld).
namespace tactus::interleave
{
namespace
{

std::string text_of(std::span<const Verb> verbs)
{
    std::string text;
    for (const Verb verb : verbs)
    {
        text += std::string(" ") + name_of(verb);
    }
    return text;
}

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a handler has no argument.
std::vector<Verb> verbs_so_far;

void tell_verbs(const char* condition, const char* file, int line) noexcept
{
    std::cerr << file << ':' << line << ": " << condition << " fails after" << text_of(verbs_so_far)
              << '\n';
}

struct FreeDeleter
{
    void operator()(std::byte* bytes) const
    {
        std::free(bytes);
    } // NOLINT: aligned_alloc's partner.
};

/// Events in all sequences, so that none remains untested.
struct Tally
{
    void add(const QueueWorld& world)
    {
        const ChunkLoaderCounters& counters = world.counters();
        for (const auto& [name, count] : {std::pair{"delivered", counters.delivered},
                                          {"evicted", world.evictions()},
                                          {"linked after arrival", world.ledger().updates()},
                                          {"linked after eviction", world.ledger().late_updates()},
                                          {"asked again", counters.asked_again},
                                          {"damaged", counters.refused_hash},
                                          {"unrequested", counters.dropped_unasked},
                                          {"without a slot", counters.dropped_no_slot},
                                          {"forgotten", counters.forgotten}})
        {
            counts[name] += count;
        }
    }

    std::uint64_t sequences{0};
    std::map<std::string, std::uint64_t> counts;
};

class PageLife : public testing::Test
{
protected:
    PageLife() : before_(set_assert_handler(tell_verbs)) {}
    ~PageLife() override { set_assert_handler(before_); }
    PageLife(const PageLife&) = delete;
    PageLife& operator=(const PageLife&) = delete;
    PageLife(PageLife&&) = delete;
    PageLife& operator=(PageLife&&) = delete;

    /// Runs every sequence of `length` verbs after `beginning`, optionally only of `allowed` ones.
    /// All events in `happens` must occur.
    void explore(const char* what, std::span<const Verb> beginning, int length,
                 std::initializer_list<const char*> happens, std::span<const Verb> allowed = {})
    {
        Choices choices;
        Tally tally;
        do
        {
            QueueWorld world(truth_, {memory_.get(), QueueWorld::kBytes});
            verbs_so_far.clear();
            for (const Verb verb : beginning)
            {
                verbs_so_far.push_back(verb);
                static_cast<void>(world.apply(verb));
            }
            if (!run(world, choices, length, allowed))
            {
                continue; // Same result as another sequence.
            }
            ASSERT_EQ(world.failure(), "") << "after" << text_of(verbs_so_far);
            world.settle();
            ASSERT_EQ(world.failure(), "") << "in settling after" << text_of(verbs_so_far);
            ++tally.sequences;
            tally.add(world);
        } while (choices.try_advance());
        std::cout << what << ": " << tally.sequences << " sequences\n";
        for (const auto& [name, count] : tally.counts)
        {
            std::cout << "  " << name << ' ' << count << '\n';
        }
        for (const char* name : happens)
        {
            EXPECT_GT(tally.counts[name], 0U) << name;
        }
    }

    test::TinyModel model_ = test::make_tiny_model(
        {.seed = 6, .base_faces = 2, .records = 150, .shuffled_ids = true, .boxes_in_a_row = true});
    Truth truth_{model_};

private:
    [[nodiscard]] static bool run(QueueWorld& world, Choices& choices, int length,
                                  std::span<const Verb> allowed);

    std::unique_ptr<std::byte, FreeDeleter> memory_{
        static_cast<std::byte*>(std::aligned_alloc(Arena::kAlignment, QueueWorld::kBytes))};
    AssertHandler before_;
};

/// Runs one sequence; false if a verb had the same result as another that is also tried.
bool PageLife::run(QueueWorld& world, Choices& choices, int length, std::span<const Verb> allowed)
{
    for (int i = 0; i < length && world.failure().empty(); ++i)
    {
        std::vector<Verb> offered = world.offered();
        if (!allowed.empty())
        {
            std::erase_if(offered, [&](Verb verb)
                          { return std::ranges::find(allowed, verb) == allowed.end(); });
        }
        const Verb verb = offered[choices.choose(offered.size())];
        verbs_so_far.push_back(verb);
        if (!world.apply(verb))
        {
            return false;
        }
    }
    return true;
}

/// Verbs that load the index page, then chunk 0, then chunk 1, each until adopted.
constexpr std::array kAllHere{Verb::want_a, Verb::step,   Verb::adopt, Verb::want_a, Verb::step,
                              Verb::adopt,  Verb::want_b, Verb::step,  Verb::adopt};
constexpr std::size_t kIndexHere = 3;
constexpr std::size_t kOneOnItsWay = 7;

/// Precondition: some records are linked after their arrival.
TEST_F(PageLife, of_a_model_whose_pages_need_each_other)
{
    EXPECT_EQ(std::popcount(truth_.linkable[0]), 64) << "the base mesh is enough";
    EXPECT_LT(std::popcount(truth_.linkable[1]), 64) << "some need chunk 2";
    EXPECT_GT(std::popcount(truth_.linkable[1]), 0) << "some don't";
}

TEST_F(PageLife, is_sound_after_every_verb_wherever_it_begins)
{
    explore("every verb, from the start", {}, 4,
            {"delivered", "asked again", "damaged", "unrequested"});
    const auto linking = {"evicted", "linked after arrival", "linked after eviction", "damaged",
                          "unrequested"};
    explore("every verb, the index page here", std::span(kAllHere).first(kIndexHere), 4, linking);
    explore("every verb, one page here and one on its way", std::span(kAllHere).first(kOneOnItsWay),
            4, linking);
    explore("every verb, every slot taken", kAllHere, 4, {"evicted", "linked after arrival"});
}

TEST_F(PageLife, is_sound_in_longer_sequences_of_usual_verbs)
{
    constexpr std::array usual{Verb::adopt, Verb::want_a, Verb::want_all,
                               Verb::evict, Verb::step,   Verb::step_holding};
    explore("usual verbs, the index page here", std::span(kAllHere).first(kIndexHere), 7,
            {"evicted", "linked after arrival"}, usual);
}

TEST_F(PageLife, is_sound_when_requests_expire_and_are_answered_late)
{
    constexpr std::array beginning{Verb::want_a, Verb::step,   Verb::adopt,
                                   Verb::want_a, Verb::want_b, Verb::step_holding};
    constexpr std::array late{Verb::adopt,   Verb::want_b, Verb::want_c,
                              Verb::be_late, Verb::step,   Verb::step_holding};
    explore("late answers, both pages on their way", beginning, 6,
            {"without a slot", "asked again"}, late);
}

} // namespace
} // namespace tactus::interleave
