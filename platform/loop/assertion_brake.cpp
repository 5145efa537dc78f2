// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/assertion_brake.hpp"

#include "platform/loop/haptic_loop.hpp"
#include "rt_core/base/assert.hpp"
#include "transport/base/exit_codes.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <poll.h>
#include <thread>
#include <unistd.h>

namespace tactus::hrtc
{

namespace
{

/// Longest wait for room on stderr; a live reader needs less.
constexpr std::chrono::seconds kPrintPatience{5};
/// Time for the main thread to finish the recording and end the process.
constexpr std::chrono::seconds kMainPatience{10};
/// Time for the devices to brake. A device behind a bus obeys brake() in the next cycle of its I/O
/// thread, which takes less.
constexpr std::chrono::milliseconds kBrakeTime{50};
constexpr std::size_t kLineBytes = 1'024; ///< Below PIPE_BUF, so that a pipe writes it atomically.

struct Failure
{
    const char* condition{nullptr};
    const char* file{nullptr};
    int line{0};
};

enum class Report : std::uint8_t
{
    none,
    noted,
    printing,
    printed,
};

// These atomics are sequentially consistent, because their cost does not matter: a process uses
// them once.
std::atomic<HapticLoop*> running_loop{nullptr};
std::atomic<std::thread::id> main_thread{};
std::atomic<bool> has_any_failed{false};
/// First failure of the process. If its thread fails again during the fade, the nested handler
/// prints this one.
Failure first_failure;
std::atomic<Report> first_report{Report::none};

/// Notes the failure if it is the process's first. Returns true then.
bool note(const Failure& failure) noexcept
{
    if (has_any_failed.exchange(true))
    {
        return false;
    }
    first_failure = failure;
    first_report.store(Report::noted);
    return true;
}

/// Waits, at most kPrintPatience, until stderr can take a line at once. False if it can't.
bool has_room_on_stderr() noexcept
{
    pollfd out{STDERR_FILENO, POLLOUT, 0};
    const auto patience = std::chrono::milliseconds(kPrintPatience);
    int ready = 0;
    do
    {
        ready = poll(&out, 1, static_cast<int>(patience.count()));
    } while (ready < 0 && errno == EINTR);
    return ready > 0 && out.revents == POLLOUT; // POLLERR would mean SIGPIPE on write.
}

using Line = std::array<char, kLineBytes>;

/// Writes a line made by snprintf, whose result is `length`. Neither allocates nor uses stdio's
/// stream, whose lock a waiting thread may hold.
void put(const Line& line, int length) noexcept
{
    if (length > 0 && has_room_on_stderr())
    {
        const std::size_t bytes = std::min(static_cast<std::size_t>(length), line.size() - 1);
        // A failed write can't be reported anywhere.
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), bytes);
    }
}

void print(const Failure& failure) noexcept
{
    Line line{};
    put(line, std::snprintf(line.data(), line.size(), "hrtc: internal error: %.600s (%.300s:%d)\n",
                            failure.condition, failure.file, failure.line));
}

void print_first() noexcept
{
    Report noted = Report::noted;
    if (first_report.compare_exchange_strong(noted, Report::printing))
    {
        print(first_failure);
        first_report.store(Report::printed);
    }
}

/// Any thread: handles a failed assertion.
void on_assertion(const char* condition, const char* file, int line) noexcept
{
    const Failure failure{condition, file, line};
    // Noting must precede the load of running_loop; see ~AssertionBrake().
    const bool is_first = note(failure);
    HapticLoop* loop = running_loop.load();
    if (loop != nullptr)
    {
        loop->fail();
    }
    print_first();
    if (!is_first)
    {
        print(failure);
    }
    if (loop != nullptr)
    {
        const bool is_main = main_thread.load() == std::this_thread::get_id();
        std::this_thread::sleep_for(is_main ? kBrakeTime : kMainPatience);
    }
    std::_Exit(kExitFailed);
}

} // namespace

void install_assertion_brake() noexcept
{
    set_assert_handler(on_assertion);
}

AssertionBrake::AssertionBrake(HapticLoop& loop) noexcept
{
    main_thread.store(std::this_thread::get_id());
    running_loop.store(&loop);
}

/// A failing thread notes the failure before it loads running_loop. So either the failure is seen
/// here and the loop is never destroyed, or that thread finds no loop.
AssertionBrake::~AssertionBrake()
{
    running_loop.store(nullptr);
    if (has_failed())
    {
        end_process();
    }
}

bool AssertionBrake::has_failed() noexcept
{
    return has_any_failed.load();
}

void AssertionBrake::end_process(std::string_view advice) noexcept
{
    while (has_failed() && first_report.load() != Report::printed)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (!advice.empty())
    {
        Line line{};
        put(line, std::snprintf(line.data(), line.size(), "hrtc: %.*s\n",
                                static_cast<int>(advice.size()), advice.data()));
    }
    std::this_thread::sleep_for(kBrakeTime);
    std::_Exit(kExitFailed);
}

} // namespace tactus::hrtc
