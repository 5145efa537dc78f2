// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/interleave/explorer.hpp"

#include "rt_core/base/assert.hpp"

#include <bit>
#include <utility>

namespace tactus::interleave
{

namespace
{

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): see Execution::current().
Execution* current_execution = nullptr;

} // namespace

Exploration explore(const MakeProgram& make, std::span<const Fault> faults)
{
    Exploration result;
    Choices choices;
    std::array<Fiber, kMaxThreads> fibers;
    do
    {
        Execution execution(choices, faults, fibers);
        execution.run(make);
        ++(execution.is_redundant() ? result.redundant : result.executions);
        result.failure = execution.failure();
    } while (result.failure.empty() && choices.try_advance());
    return result;
}

Execution::Execution(Choices& choices, std::span<const Fault> faults, std::span<Fiber> fibers)
    : choices_(choices), fibers_(fibers), memory_(choices, faults)
{
    TACTUS_ASSERT(current_execution == nullptr);
    current_execution = this;
}

Execution::~Execution()
{
    current_execution = nullptr;
}

Execution& Execution::current()
{
    TACTUS_ASSERT(current_execution != nullptr);
    return *current_execution;
}

void Execution::run(const MakeProgram& make)
{
    const std::unique_ptr<Program> program = make();
    std::vector<std::function<void()>> bodies = program->threads();
    count_ = bodies.size();
    TACTUS_ASSERT(count_ <= kMaxThreads);
    memory_.begin_threads();
    for (std::size_t thread = 0; thread < count_; ++thread)
    {
        fibers_[thread].start(std::move(bodies[thread]));
        resume(thread); // Runs to its first operation; earlier code concerns no other thread.
    }
    ThreadSet asleep = 0;
    for (ThreadSet left = waiting(); left != 0; left = waiting())
    {
        if ((left & ~asleep) == 0 && !is_redundant_)
        {
            is_redundant_ = true;
            memory_.stop_branching();
        }
        if (is_redundant_) // Runs to the end, so that every fiber's stack is unwound.
        {
            resume(static_cast<std::size_t>(std::countr_zero(left)));
            continue;
        }
        const ThreadSet awake = left & ~asleep;
        const std::size_t chosen = choose_thread(awake);
        // Awake threads with lower numbers were tried here before.
        asleep = still_asleep(asleep | (awake & ((1U << chosen) - 1U)), chosen);
        resume(chosen);
    }
    memory_.join_threads();
    if (!is_redundant_)
    {
        program->at_end();
    }
}

Execution::ThreadSet Execution::waiting() const
{
    ThreadSet set = 0;
    for (std::size_t thread = 0; thread < count_; ++thread)
    {
        set |= fibers_[thread].is_done() ? 0U : 1U << thread;
    }
    return set;
}

std::size_t Execution::choose_thread(ThreadSet awake)
{
    const auto count = static_cast<std::size_t>(std::popcount(awake));
    for (std::size_t skipped = count > 1 ? choices_.choose(count) : 0; skipped > 0; --skipped)
    {
        awake &= awake - 1;
    }
    return static_cast<std::size_t>(std::countr_zero(awake));
}

/// Threads whose next operation commutes with that of `chosen`.
Execution::ThreadSet Execution::still_asleep(ThreadSet asleep, std::size_t chosen) const
{
    for (std::size_t thread = 0; thread < count_; ++thread)
    {
        const bool commutes = next_[thread].location != next_[chosen].location ||
                              (!next_[thread].is_store && !next_[chosen].is_store);
        asleep &= commutes ? ~ThreadSet{0} : ~(1U << thread);
    }
    return asleep & ~(1U << chosen);
}

void Execution::resume(std::size_t thread)
{
    running_ = thread;
    fibers_[thread].resume();
    running_ = kMainThread;
}

void Execution::wait_turn(Operation next)
{
    if (running_ == kMainThread)
    {
        return;
    }
    next_[running_] = next;
    fibers_[running_].pause();
}

std::size_t Execution::add_location(std::uint64_t value)
{
    return memory_.add_location(value);
}

std::uint64_t Execution::load(std::size_t location, std::memory_order order)
{
    if (!memory_.is_own(running_, location))
    {
        wait_turn({location, false});
    }
    return memory_.load(running_, location, order);
}

void Execution::store(std::size_t location, std::uint64_t value, std::memory_order order)
{
    wait_turn({location, true});
    memory_.store(running_, location, value, order);
}

} // namespace tactus::interleave
