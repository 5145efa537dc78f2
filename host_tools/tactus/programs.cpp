// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/tactus/programs.hpp"

#include "platform/program/run_program.hpp"
#include "transport/base/exit_codes.hpp"
#include "transport/base/program_log.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>

namespace tactus::tactus_program
{

namespace
{

std::string path_of(std::string_view name)
{
    std::error_code unread;
    return std::filesystem::read_symlink("/proc/self/exe", unread).parent_path() / name;
}

std::string reason()
{
    return std::generic_category().message(errno);
}

} // namespace

std::optional<Refusal> fault_of_program(std::string_view name)
{
    const std::string path = path_of(name);
    return ::access(path.c_str(), X_OK) == 0
               ? std::nullopt
               : std::optional(
                     Refusal{fmt::format("{}: {}; the package {} has it", path, reason(),
                                         name == "hrtc" ? "tactus-controller" : "tactus-host")});
}

Refusal become(std::string_view name, std::vector<std::string> arguments)
{
    if (auto fault = fault_of_program(name))
    {
        return *std::move(fault);
    }
    std::string path = path_of(name);
    std::vector<char*> words{path.data()};
    for (std::string& argument : arguments)
    {
        words.push_back(argument.data());
    }
    words.push_back(nullptr);
    ::execv(path.c_str(), words.data());
    return {fmt::format("{}: {}", path, reason())};
}

pid_t start(std::string_view name, std::vector<std::string> arguments)
{
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process < 0)
    {
        log_message(LogLevel::error, "tactus", fmt::format("{}: {}", name, reason()));
    }
    if (process != 0)
    {
        return process;
    }
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    std::signal(SIGPIPE, SIG_DFL); // stop_on_signals() ignores both, which exec would pass on.
    std::signal(SIGXFSZ, SIG_DFL);
    if (::getppid() == parent) // Otherwise the parent ended before prctl().
    {
        log_message(LogLevel::error, "tactus", become(name, std::move(arguments)).text);
    }
    ::_exit(kExitFailed);
}

int wait_for(pid_t process)
{
    bool is_passed_on = false;
    int status = 0;
    pid_t ended = process;
    while (process > 0 && (ended = ::waitpid(process, &status, WNOHANG)) == 0)
    {
        if (is_stop_requested() && !is_passed_on)
        {
            is_passed_on = true;
            ::kill(process, SIGTERM);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return ended > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : kExitFailed;
}

} // namespace tactus::tactus_program
