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

/// The newest value of one writer, for any number of readers, without a lock (a seqlock): the
/// writer never waits; a reader that meets a write tries again a few times, then gives up.
///
/// The count is odd while a write is under way. Words are stored with release and loaded with
/// acquire, so that a reader that saw a word of a write also sees, in its second look at the
/// count, that this write began; a fence would do as well, but the thread sanitizer knows none.
///
/// `Atomic` and `tries` are others in tests/interleave only, which runs this code in every order
/// that the memory model allows.
template <typename T, template <typename> typename Atomic = std::atomic, int tries = 16>
class Mailbox
{
    static_assert(std::is_trivially_copyable_v<T>);

public:
    /// A write takes some 20 ns: only a writer that lost its processor in the middle of one makes
    /// a reader run out of tries.
    static constexpr int kTries = tries;

    /// The writer's thread.
    void write(const T& value) noexcept
    {
        Words words{};
        std::memcpy(words.data(), &value, sizeof(T));
        const std::uint64_t count = count_.load(std::memory_order_relaxed); // Only we write it.
        count_.store(count + 1, std::memory_order_relaxed); // The words' releases publish it.
        for (std::size_t i = 0; i < kWords; ++i)
        {
            words_[i].store(words[i], std::memory_order_release); // Pairs with try_read().
        }
        count_.store(count + 2, std::memory_order_release); // Pairs with try_read().
    }

    /// Any thread. False, with `value` as it was, when nothing was written yet or when each try met
    /// a write: keep what you have. Bounded: kTries copies.
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
            // Not before the words were loaded: their acquires see to it.
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
