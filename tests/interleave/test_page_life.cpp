// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/interleave/choices.hpp"
#include "tests/interleave/door_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// The life of pages between the two threads: the product's courier, linker, cache and page table,
/// driven through every sequence of verbs up to a length (see DoorWorld).
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
    std::cerr << file << ':' << line << ": " << condition << " fails after"
              << text_of(verbs_so_far) << '\n';
}

struct FreeDeleter
{
    void operator()(std::byte* bytes) const { std::free(bytes); } // NOLINT: aligned_alloc's partner.
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

    /// Every sequence of `length` verbs after those of `beginning`; of `allowed` ones, where given.
    void explore(const char* what, std::span<const Verb> beginning, int length,
                 std::span<const Verb> allowed = {})
    {
        Choices choices;
        std::uint64_t sequences = 0;
        do
        {
            DoorWorld world(truth_, {memory_.get(), DoorWorld::kBytes});
            verbs_so_far.clear();
            for (const Verb verb : beginning)
            {
                verbs_so_far.push_back(verb);
                static_cast<void>(world.apply(verb));
            }
            if (!run(world, choices, length, allowed))
            {
                continue; // Came to the same as another.
            }
            ASSERT_EQ(world.failure(), "") << "after" << text_of(verbs_so_far);
            ++sequences;
            world.settle();
            ASSERT_EQ(world.failure(), "") << "in settling after" << text_of(verbs_so_far);
        } while (choices.try_advance());
        std::cout << what << ": " << sequences << " sequences\n";
    }

private:
    [[nodiscard]] static bool run(DoorWorld& world, Choices& choices, int length,
                                  std::span<const Verb> allowed);

    test::TinyModel model_ =
        test::make_tiny_model({.records = 150, .shuffled_ids = true, .boxes_in_a_row = true});
    Truth truth_{model_};
    std::unique_ptr<std::byte, FreeDeleter> memory_{static_cast<std::byte*>(
        std::aligned_alloc(Arena::kAlignment, DoorWorld::kBytes))};
    AssertHandler before_;
};

/// False when a verb came to the same as another that is tried, too.
bool PageLife::run(DoorWorld& world, Choices& choices, int length, std::span<const Verb> allowed)
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

TEST_F(PageLife, is_sound_from_the_start)
{
    explore("every verb, from the start", {}, 4);
}

TEST_F(PageLife, is_sound_with_one_page_here_and_one_on_its_way)
{
    explore("every verb, one page here and one on its way",
            std::array{Verb::want_a, Verb::step, Verb::adopt, Verb::want_a, Verb::step, Verb::adopt,
                       Verb::want_b},
            4);
}

} // namespace
} // namespace tactus::interleave
