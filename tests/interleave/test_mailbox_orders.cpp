// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/mailbox.hpp"
#include "tests/interleave/checked.hpp"
#include "tests/interleave/expect_sound.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

/// The product's Mailbox, of two words and with two tries a read, in every order that the memory
/// model permits, and with each of its orders weakened, which must be detected.
namespace tactus::interleave
{
namespace
{

struct Letter
{
    std::uint64_t number{0};
    std::uint64_t copy{0};
};

struct Post
{
    /// Reads a letter that must be whole and no older than the last one.
    void read()
    {
        Letter letter{last, last};
        const bool is_read = mailbox.try_read(letter);
        require(letter.number == letter.copy, "a torn letter");
        require(letter.number >= last, "an older letter");
        require(is_read || letter.number == last, "a refused read wrote the value");
        require(!is_read || letter.number > 0, "a letter that nobody wrote");
        last = letter.number;
    }

    Mailbox<Letter, CheckedAtomic, 2> mailbox;
    std::uint64_t last{0}; ///< Last letter of the reader.
};

Exploration write_and_read(std::uint64_t letters, int reads, std::span<const Fault> faults = {})
{
    return explore_small<Post>(
        {[=](Post& post)
         {
             for (std::uint64_t i = 1; i <= letters; ++i)
             {
                 post.mailbox.write({i, i});
             }
         },
         [=](Post& post)
         {
             for (int i = 0; i < reads; ++i)
             {
                 post.read();
             }
         }},
        [](Post& post)
        {
            post.read();
            require(post.last > 0, "the last letter is not there");
        },
        faults);
}

TEST(MailboxOrders, gives_whole_letters_that_never_get_older)
{
    expect_sound("one letter, two reads", write_and_read(1, 2), 101);
    expect_sound("two letters, one read", write_and_read(2, 1), 101);
}

TEST(MailboxOrders, each_weaker_order_is_found)
{
    for (std::size_t location = 0; location < 3; ++location)
    {
        for (const bool is_store : {false, true})
        {
            const std::array faults{Fault{.location = location, .is_store = is_store}};
            const bool is_found = !write_and_read(1, 2, faults).failure.empty() ||
                                  !write_and_read(2, 1, faults).failure.empty();
            EXPECT_TRUE(is_found) << (is_store ? "store " : "load ") << location;
        }
    }
}

} // namespace
} // namespace tactus::interleave
