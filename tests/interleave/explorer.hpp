// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/interleave/fiber.hpp"
#include "tests/interleave/memory.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tactus::interleave
{

/// A small program of a few threads, built anew for each execution. Threads share CheckedAtomic and
/// CheckedSlot (checked.hpp); what else they share must not decide what they do. Each must end
/// after a bounded number of steps.
class Program
{
public:
    Program() = default;
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    Program(Program&&) = delete;
    Program& operator=(Program&&) = delete;
    virtual ~Program() = default;

    /// At most kMaxThreads.
    [[nodiscard]] virtual std::vector<std::function<void()>> threads() = 0;
    /// After all threads ended.
    virtual void at_end() {}
};

struct Exploration
{
    std::uint64_t executions{0}; ///< Run to the end; no two differ only by what commutes.
    std::uint64_t redundant{0};  ///< Given up, since one before differs only so.
    std::string failure;         ///< The first, with the schedule that led to it; empty: none.
};

using MakeProgram = std::function<std::unique_ptr<Program>()>;

/// Runs the program in every order of its threads' atomic operations, with every value that each
/// load may return, or until one execution fails.
///
/// Depth first and from the start each time. An order is left out when it differs from one before
/// by operations that don't touch the same location, or only load it (sleep sets: a thread whose
/// next operation was tried here isn't tried again until another one touches its location).
[[nodiscard]] Exploration explore(const MakeProgram& make, std::span<const Fault> faults = {});

/// One run of a program; what its threads' operations go through.
class Execution
{
public:
    Execution(Choices& choices, std::span<const Fault> faults, std::span<Fiber> fibers);
    Execution(const Execution&) = delete;
    Execution& operator=(const Execution&) = delete;
    Execution(Execution&&) = delete;
    Execution& operator=(Execution&&) = delete;
    ~Execution();

    void run(const MakeProgram& make);
    [[nodiscard]] bool is_redundant() const { return is_redundant_; }
    [[nodiscard]] const std::string& failure() const { return memory_.failure(); }

    /// The one that is running: there is one thread of the machine, and one execution at a time.
    [[nodiscard]] static Execution& current();

    [[nodiscard]] std::size_t add_location(std::uint64_t value);
    [[nodiscard]] std::uint64_t load(std::size_t location, std::memory_order order);
    void store(std::size_t location, std::uint64_t value, std::memory_order order);
    void read_plain(PlainHistory& history) { memory_.read_plain(running_, history); }
    void write_plain(PlainHistory& history) { memory_.write_plain(running_, history); }
    [[nodiscard]] Moment now() const { return memory_.now(running_); }
    [[nodiscard]] bool has_seen(Moment moment) const { return memory_.has_seen(running_, moment); }
    void fail(const std::string& what) { memory_.fail(what); }

private:
    using ThreadSet = std::uint32_t; ///< One bit a thread.
    struct Operation
    {
        std::size_t location{0};
        bool is_store{false};
    };

    void wait_turn(Operation next);
    void resume(std::size_t thread);
    [[nodiscard]] ThreadSet waiting() const;
    [[nodiscard]] std::size_t choose_thread(ThreadSet awake);
    [[nodiscard]] ThreadSet still_asleep(ThreadSet asleep, std::size_t chosen) const;

    Choices& choices_;
    std::span<Fiber> fibers_;
    Memory memory_;
    std::size_t count_{0};
    std::size_t running_{kMainThread};
    std::array<Operation, kMaxThreads> next_{};
    bool is_redundant_{false};
};

} // namespace tactus::interleave
