// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/child_process.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

namespace tactus::bench
{

namespace
{

using Work = Result<std::string, SceneError>;

/// An address sanitizer keeps what was freed, to tell when it is used again.
constexpr bool keeps_freed_memory()
{
#if defined(__SANITIZE_ADDRESS__)
    return true;
#elif defined(__has_feature)
    return __has_feature(address_sanitizer);
#else
    return false;
#endif
}

std::uint64_t peak_of_touching(std::size_t bytes)
{
    const auto outcome = run_in_child(
        [bytes]
        {
            const std::vector<char> memory(bytes, 'x');
            return Work(std::string(1, memory.back()));
        });
    EXPECT_TRUE(outcome);
    return outcome ? outcome.value().peak_bytes : 0;
}

TEST(RunInChild, peak_is_the_childs_own)
{
    constexpr std::size_t kMuch = std::size_t{256} << 20U;
    const std::uint64_t before = peak_of_touching(1);
    if (before == 0)
    {
        GTEST_SKIP() << "the system doesn't tell a child's peak of memory";
    }

    EXPECT_GE(peak_of_touching(kMuch), kMuch);
    EXPECT_LT(peak_of_touching(1), before + kMuch / 2);
}

TEST(RunInChild, peak_has_nothing_of_what_was_freed_here)
{
    constexpr std::size_t kBlocks = 1'000'000;
    const std::uint64_t before = peak_of_touching(1);
    if (before == 0 || keeps_freed_memory())
    {
        GTEST_SKIP() << "the system doesn't tell a child's peak of memory, or a sanitizer keeps it";
    }
    std::vector<std::unique_ptr<std::array<char, 64>>> blocks(kBlocks);
    for (auto& block : blocks)
    {
        block = std::make_unique<std::array<char, 64>>();
    }
    auto last = std::make_unique<char>('x'); // Keeps the heap from shrinking by itself.
    blocks.clear();

    EXPECT_LT(peak_of_touching(1), before + kBlocks * 32) << *last;
}

} // namespace

} // namespace tactus::bench
