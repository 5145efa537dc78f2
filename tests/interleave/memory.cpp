// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/interleave/memory.hpp"

#include <algorithm>

namespace tactus::interleave
{

namespace
{

std::string name_of(std::size_t thread)
{
    return thread == kMainThread ? "main" : "thread " + std::to_string(thread);
}

const char* name_of(std::memory_order order)
{
    return order == std::memory_order_acquire   ? "acquire"
           : order == std::memory_order_release ? "release"
                                                : "relaxed";
}

} // namespace

std::size_t Memory::add_location(std::uint64_t value)
{
    if (locations_.size() == kMaxLocations)
    {
        fail("the program has too many locations");
        return kMaxLocations - 1;
    }
    locations_.emplace_back();
    locations_.back().stores.push_back({value, false, {}});
    return locations_.size() - 1;
}

void Memory::begin_threads()
{
    for (std::size_t thread = 0; thread < kMaxThreads; ++thread)
    {
        threads_[thread] = threads_[kMainThread];
        threads_[thread].clock[thread] = 1;
    }
    ++threads_[kMainThread].clock[kMainThread];
}

void Memory::join_threads()
{
    for (std::size_t thread = 0; thread < kMaxThreads; ++thread)
    {
        join(threads_[kMainThread], threads_[thread]);
    }
    stop_branching();
}

std::uint64_t Memory::load(std::size_t thread, std::size_t location, std::memory_order order)
{
    if (order != std::memory_order_relaxed && order != std::memory_order_acquire)
    {
        fail("a load with an order that is not modelled");
    }
    const std::memory_order used = weakened(thread, location, false, order);
    const std::vector<Store>& stores = locations_[location].stores;
    Knowledge& known = threads_[thread];
    const std::size_t visible = stores.size() - known.view[location];
    const std::size_t newer = visible > 1 && branches_ ? choices_.choose(visible) : 0;
    const std::size_t seen = stores.size() - 1 - newer;
    const Store& store = stores[seen];
    known.view[location] = static_cast<std::uint32_t>(seen);
    if (used == std::memory_order_acquire && store.is_release)
    {
        join(known, store.knowledge);
    }
    events_.push_back({thread, location, false, store.value, newer, used});
    return store.value + static_cast<std::uint64_t>(offset(thread, location));
}

void Memory::store(std::size_t thread, std::size_t location, std::uint64_t value,
                   std::memory_order order)
{
    if (order != std::memory_order_relaxed && order != std::memory_order_release)
    {
        fail("a store with an order that is not modelled");
    }
    const std::memory_order used = weakened(thread, location, true, order);
    events_.push_back({thread, location, true, value, 0, used});
    Location& at = locations_[location];
    if (thread != kMainThread && at.writer != kMainThread && at.writer != thread)
    {
        fail("a second thread writes the same location");
    }
    at.writer = thread;
    Knowledge& known = threads_[thread];
    known.view[location] = static_cast<std::uint32_t>(at.stores.size());
    if (used == std::memory_order_release)
    {
        at.stores.push_back({value, true, known});
        ++known.clock[thread]; // Later operations of the thread are not published.
        return;
    }
    at.stores.push_back({value, false, {}});
}

bool Memory::is_own(std::size_t thread, std::size_t location) const
{
    return locations_[location].writer == thread;
}

void Memory::read_plain(std::size_t thread, PlainHistory& history)
{
    if (!has_seen(thread, history.written))
    {
        fail("race: " + name_of(thread) + " reads what " + name_of(history.written.thread) +
             " wrote");
    }
    history.read[thread] = now(thread).time;
}

void Memory::write_plain(std::size_t thread, PlainHistory& history)
{
    if (!has_seen(thread, history.written))
    {
        fail("race: " + name_of(thread) + " writes over what " + name_of(history.written.thread) +
             " wrote");
    }
    for (std::size_t reader = 0; reader < history.read.size(); ++reader)
    {
        if (!has_seen(thread, {reader, history.read[reader]}))
        {
            fail("race: " + name_of(thread) + " writes what " + name_of(reader) + " reads");
        }
    }
    history.written = now(thread);
}

void Memory::fail(const std::string& what)
{
    if (!failure_.empty())
    {
        return;
    }
    failure_ = what + "; after\n";
    for (const Event& event : events_)
    {
        failure_ += text_of(event);
    }
}

void Memory::join(Knowledge& into, const Knowledge& from)
{
    for (std::size_t i = 0; i < into.clock.size(); ++i)
    {
        into.clock[i] = std::max(into.clock[i], from.clock[i]);
    }
    for (std::size_t i = 0; i < into.view.size(); ++i)
    {
        into.view[i] = std::max(into.view[i], from.view[i]);
    }
}

std::memory_order Memory::weakened(std::size_t thread, std::size_t location, bool is_store,
                                   std::memory_order order) const
{
    const bool is_weak = std::ranges::any_of(faults_,
                                             [&](const Fault& fault)
                                             {
                                                 return fault.adds == 0 &&
                                                        fault.location == location &&
                                                        fault.is_store == is_store &&
                                                        fault.thread.value_or(thread) == thread;
                                             });
    return is_weak ? std::memory_order_relaxed : order;
}

std::int64_t Memory::offset(std::size_t thread, std::size_t location) const
{
    std::int64_t sum = 0;
    for (const Fault& fault : faults_)
    {
        const bool is_meant = fault.location == location && !fault.is_store &&
                              fault.thread.value_or(thread) == thread;
        sum += is_meant ? fault.adds : 0;
    }
    return sum;
}

std::string Memory::text_of(const Event& event)
{
    std::string text = "  " + name_of(event.thread) + (event.is_store ? ": store " : ": load  ") +
                       std::to_string(event.location) + (event.is_store ? " = " : " -> ") +
                       std::to_string(event.value) + " (" + name_of(event.order);
    if (event.newer > 0)
    {
        text += ", " + std::to_string(event.newer) + " newer";
    }
    return text + ")\n";
}

} // namespace tactus::interleave
