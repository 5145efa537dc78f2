// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace tactus
{

/// The newest value of one writer, for any number of readers, without a lock (a seqlock). The
/// writer never waits; a reader that meets a write tries again a few times, then gives up.
///
/// The count is odd while a write is under way. Words are stored with release and loaded with
/// acquire: a reader that saw a word of a write also sees, when it loads the count again, that this
/// write began. A fence would do as well, but the thread sanitizer does not support fences.
///
/// Only tests/interleave sets `Atomic` and `tries`; it runs this code in every order that the
/// memory model allows.
template <typename T, template <typename> typename Atomic = std::atomic, int tries = 16>
class Mailbox
{
    static_assert(std::is_trivially_copyable_v<T>);

public:
    /// A write takes about 20 ns: a reader runs out of tries only if the writer lost its processor
    /// in the middle of a write.
    static constexpr int kTries = tries;

    /// The writer's thread only.
    void write(const T& value) noexcept
    {
        Words words{};
        std::memcpy(words.data(), &value, sizeof(T));
        const std::uint64_t count = count_.load(std::memory_order_relaxed); // No other writer.
        count_.store(count + 1, std::memory_order_relaxed); // The words' releases publish it.
        for (std::size_t i = 0; i < kWords; ++i)
        {
            words_[i].store(words[i], std::memory_order_release); // Pairs with try_read().
        }
        count_.store(count + 2, std::memory_order_release); // Pairs with try_read().
    }

    /// Any thread. False, with `value` unchanged, if nothing was written yet or each try met a
    /// write. At most kTries copies.
    [[nodiscard]] bool try_read(T& value) const noexcept
    {
        for (int i = 0; i < kTries; ++i)
        {
            const std::uint64_t before = count_.load(std::memory_order_acquire); // See write().
            Words words;
            for (std::size_t word = 0; word < kWords; ++word)
            {
                words[word] = words_[word].load(std::memory_order_acquire); // See write().
            }
            // The acquires of the words keep this load behind them.
            const bool is_whole = count_.load(std::memory_order_relaxed) == before;
            if (is_whole && before % 2 == 0)
            {
                return before != 0 && take(words, value);
            }
        }
        return false;
    }

private:
    static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
    using Words = std::array<std::uint64_t, kWords>;

    static bool take(const Words& words, T& value) noexcept
    {
        std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
        return true;
    }

    alignas(64) Atomic<std::uint64_t> count_{0};
    std::array<Atomic<std::uint64_t>, kWords> words_{};
};

} // namespace tactus
