// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/child_process.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <malloc.h>
#include <string_view>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tactus::bench
{

namespace
{

constexpr int kWorkDone = 0;
constexpr int kWorkFailed = 1;

void write_all(int file, std::string_view text)
{
    while (!text.empty())
    {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written < 0 && errno != EINTR)
        {
            ::_exit(kWorkFailed);
        }
        text.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
    }
}

std::string read_all(int file)
{
    std::string text;
    std::array<char, 4'096> buffer{};
    ssize_t count = 0;
    do
    {
        count = ::read(file, buffer.data(), buffer.size());
        text.append(buffer.data(), count < 0 ? 0 : static_cast<std::size_t>(count));
    } while (count > 0 || (count < 0 && errno == EINTR));
    return text;
}

/// Body of the child. It exits without the parent's destructors and buffers.
[[noreturn]] void live(int answer, const std::function<std::string()>& work)
{
    int code = kWorkFailed;
    std::string text;
    try
    {
        text = work();
        code = kWorkDone;
    }
    catch (const std::exception& error)
    {
        text = error.what();
    }
    write_all(answer, text);
    ::_exit(code);
}

} // namespace

ChildOutcome run_in_child(const std::function<std::string()>& work)
{
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0)
    {
        throw Failure(fmt::format("no pipe to a child process: {}", std::strerror(errno)));
    }
    ::malloc_trim(0); // The child inherits memory that was freed but not returned.
    const pid_t child = ::fork();
    if (child == 0)
    {
        ::close(ends[0]);
        live(ends[1], work);
    }
    const int fork_error = errno;
    ::close(ends[1]);
    const std::string text = child < 0 ? "" : read_all(ends[0]);
    ::close(ends[0]);
    if (child < 0)
    {
        throw Failure(fmt::format("no child process: {}", std::strerror(fork_error)));
    }
    int status = 0;
    rusage usage{};
    while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR)
    {
    }
    if (WIFSIGNALED(status))
    {
        throw Failure(fmt::format("a child process was ended by signal {}", WTERMSIG(status)));
    }
    if (WEXITSTATUS(status) != kWorkDone)
    {
        throw Failure(text);
    }
    return ChildOutcome{text, static_cast<std::uint64_t>(usage.ru_maxrss) * 1'024};
}

} // namespace tactus::bench
