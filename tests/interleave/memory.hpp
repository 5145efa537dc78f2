// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/interleave/choices.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::interleave
{

inline constexpr std::size_t kMaxThreads = 4;
/// Pseudo-thread that builds the program before its threads start and inspects it after they ended.
inline constexpr std::size_t kMainThread = kMaxThreads;
inline constexpr std::size_t kMaxLocations = 16;

/// Fault in the code under test: operations of one kind on one location (numbered in the order of
/// construction, from 0) become relaxed, or a load's value is changed.
struct Fault
{
    std::size_t location{0};
    bool is_store{false};
    std::int64_t adds{0};                ///< Added to a load's value; 0: relaxes instead.
    std::optional<std::size_t> thread{}; ///< Affected thread; empty: every thread.
};

/// Moment in one thread's execution.
struct Moment
{
    std::size_t thread{kMainThread};
    std::uint32_t time{0};
};

/// Accesses to a plain variable, by thread and time.
struct PlainHistory
{
    Moment written;
    std::array<std::uint32_t, kMaxThreads + 1> read{};
};

/// Memory of one execution: the stores, and the ones visible to each thread.
///
/// The stores of every location have one order. A load may return the newest store that its thread
/// knows (has read or written, or learnt of by an acquire from a release) and every later one: a
/// thread never goes back, and staleness ends by happens-before. A thread's knowledge is one place
/// in that order for each location (its view), and its progress in the others' executions (its
/// clock), which decides about plain accesses.
///
/// Exact for relaxed, acquire and release of C++20 as long as only one thread writes each location
/// (otherwise the program fails) and no relaxed load is moved behind a later store of its thread.
/// No fences, no seq_cst and no read-modify-writes.
class Memory
{
public:
    Memory(Choices& choices, std::span<const Fault> faults) : choices_(choices), faults_(faults) {}

    [[nodiscard]] std::size_t add_location(std::uint64_t value);
    /// Publishes the main thread's operations to all threads at the start, and theirs to it at the
    /// end.
    void begin_threads();
    void join_threads();

    [[nodiscard]] std::uint64_t load(std::size_t thread, std::size_t location,
                                     std::memory_order order);
    void store(std::size_t thread, std::size_t location, std::uint64_t value,
               std::memory_order order);
    /// True if no other thread has written the location: an access then has no meaning for others.
    [[nodiscard]] bool is_own(std::size_t thread, std::size_t location) const;

    void read_plain(std::size_t thread, PlainHistory& history);
    void write_plain(std::size_t thread, PlainHistory& history);

    [[nodiscard]] Moment now(std::size_t thread) const
    {
        return {thread, threads_[thread].clock[thread]};
    }
    [[nodiscard]] bool has_seen(std::size_t thread, Moment moment) const
    {
        return moment.time <= threads_[thread].clock[moment.thread];
    }

    /// Lets loads return the newest value from now on, without branches.
    void stop_branching() { branches_ = false; }
    void fail(const std::string& what);
    /// First failure with its history; empty if there is none.
    [[nodiscard]] const std::string& failure() const { return failure_; }

private:
    using Clock = std::array<std::uint32_t, kMaxThreads + 1>;
    using View = std::array<std::uint32_t, kMaxLocations>;
    struct Knowledge
    {
        Clock clock{};
        View view{};
    };
    struct Store
    {
        std::uint64_t value{0};
        bool is_release{false};
        Knowledge knowledge; ///< Knowledge of the writer, for a release.
    };
    struct Location
    {
        std::vector<Store> stores;
        std::size_t writer{kMainThread};
    };
    struct Event
    {
        std::size_t thread{0};
        std::size_t location{0};
        bool is_store{false};
        std::uint64_t value{0};
        std::size_t newer{0}; ///< Stores that a load did not see.
        std::memory_order order{};
    };

    static void join(Knowledge& into, const Knowledge& from);
    [[nodiscard]] std::memory_order weakened(std::size_t thread, std::size_t location,
                                             bool is_store, std::memory_order order) const;
    [[nodiscard]] std::int64_t offset(std::size_t thread, std::size_t location) const;
    [[nodiscard]] static std::string text_of(const Event& event);

    Choices& choices_;
    std::span<const Fault> faults_;
    std::vector<Location> locations_;
    std::array<Knowledge, kMaxThreads + 1> threads_{};
    std::vector<Event> events_;
    std::string failure_;
    bool branches_{true};
};

} // namespace tactus::interleave
