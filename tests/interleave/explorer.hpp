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

/// Small program of a few threads, created for each execution. Threads share CheckedAtomic and
/// CheckedSlot (checked.hpp); other shared data must not affect them. Each must end after a bounded
/// number of steps.
class Program
{
public:
    Program() = default;
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    virtual ~Program() = default;

    /// Threads, at most kMaxThreads.
    [[nodiscard]] virtual std::vector<std::function<void()>> threads() = 0;
    /// Called after all threads ended.
    virtual void at_end() {}
};

struct Exploration
{
    /// Complete executions; no two differ only by commuting operations.
    std::uint64_t executions{0};
    std::uint64_t redundant{0}; ///< Abandoned executions that differ only so from an earlier one.
    std::string failure;        ///< First failure with its schedule; empty: none.
};

using MakeProgram = std::function<std::unique_ptr<Program>()>;

/// Runs the program in every order of its threads' atomic operations, with every value that each
/// load may return, or until one execution fails.
///
/// Depth first, from the start each time. An order is skipped if it differs from an earlier one by
/// operations on different locations, or loads only (sleep sets: a thread whose next operation was
/// tried here is not tried again until another one touches its location).
[[nodiscard]] Exploration explore(const MakeProgram& make, std::span<const Fault> faults = {});

/// One run of a program, which its threads' operations call.
class Execution
{
public:
    Execution(Choices& choices, std::span<const Fault> faults, std::span<Fiber> fibers);
    Execution(const Execution&) = delete;
    Execution& operator=(const Execution&) = delete;
    ~Execution();

    void run(const MakeProgram& make);
    [[nodiscard]] bool is_redundant() const { return is_redundant_; }
    [[nodiscard]] const std::string& failure() const { return memory_.failure(); }

    /// Present execution: there is one real thread, and one execution at a time.
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
    using ThreadSet = std::uint32_t; ///< Set with one bit a thread.
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
