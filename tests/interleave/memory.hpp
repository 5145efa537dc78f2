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
/// Builds the program before its threads start, and looks at what is left after they ended.
inline constexpr std::size_t kMainThread = kMaxThreads;
inline constexpr std::size_t kMaxLocations = 16;

/// A wrong turn put into the code under test: operations of one kind on one location (counted as
/// they were built, from 0) become relaxed, or a load's value is off.
struct Fault
{
    std::size_t location{0};
    bool is_store{false};
    std::int64_t adds{0};                ///< To what a load returns; 0: relaxes instead.
    std::optional<std::size_t> thread{}; ///< None: on every thread.
};

/// A moment in one thread's life.
struct Moment
{
    std::size_t thread{kMainThread};
    std::uint32_t time{0};
};

/// Who has looked at a plain variable, and when.
struct PlainHistory
{
    Moment written;
    std::array<std::uint32_t, kMaxThreads + 1> read{};
};

/// The memory of one execution: what each store left, and which of it each thread may see.
///
/// Of every location the stores stand in one order. A load may return the newest one that its
/// thread knows of (has read or written, or learnt of by an acquire from a release), and every
/// later one: so a thread never goes back, and staleness ends where happens-before says so. What a
/// thread knows is one place in that order for each location (its view), and how far it has seen of
/// the others' lives (its clock), by which plain accesses are judged.
///
/// Exact for relaxed, acquire and release, as C++20 has them, while only one thread writes each
/// location (anything else is reported as a failure of the program) and no relaxed load is moved
/// behind a later store of its thread. There are no fences, no seq_cst and no read-modify-writes.
class Memory
{
public:
    Memory(Choices& choices, std::span<const Fault> faults) : choices_(choices), faults_(faults) {}

    [[nodiscard]] std::size_t add_location(std::uint64_t value);
    /// The threads begin knowing all that the main thread did, which afterwards knows all of
    /// theirs.
    void begin_threads();
    void join_threads();

    [[nodiscard]] std::uint64_t load(std::size_t thread, std::size_t location,
                                     std::memory_order order);
    void store(std::size_t thread, std::size_t location, std::uint64_t value,
               std::memory_order order);
    /// Whether nobody else has written it: an access then means nothing to the others.
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

    /// From now on loads return the newest value and nothing branches.
    void stop_branching() { branches_ = false; }
    void fail(const std::string& what);
    /// What went wrong first, and all that happened before it; empty while nothing did.
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
        Knowledge knowledge; ///< The writer's, when it is a release.
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
