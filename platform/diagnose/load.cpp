// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/load.hpp"

#include "platform/machine/posix/linux_extras.hpp"
#include "platform/program/command_line.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

extern "C" char** environ;

namespace tactus::hrtc
{

namespace
{

constexpr std::size_t kMemoryBytes = std::size_t{64} << 20U;
constexpr std::size_t kMappedBytes = std::size_t{4} << 20U;
constexpr std::size_t kDiskBytes = std::size_t{16} << 20U;
constexpr std::size_t kBlockBytes = std::size_t{1} << 20U;

std::string error_text(int error)
{
    return std::generic_category().message(error);
}

/// Next number of Marsaglia's xorshift64.
std::uint64_t next(std::uint64_t x) noexcept
{
    x ^= x << 13U;
    x ^= x >> 7U;
    return x ^ (x << 17U);
}

void calculate(bool (*goes_on)())
{
    std::uint64_t x = 1;
    volatile std::uint64_t seen = 0; // Keeps the compiler from dropping the calculation.
    while (goes_on())
    {
        for (int i = 0; i < 2'000'000; ++i)
        {
            x = next(x);
        }
        seen = x;
    }
    static_cast<void>(seen);
}

std::optional<std::string> map_and_touch()
{
    void* mapped =
        mmap(nullptr, kMappedBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED)
    {
        return "no memory can be mapped: " + error_text(errno);
    }
    std::memset(mapped, 1, kMappedBytes);
    munmap(mapped, kMappedBytes);
    return std::nullopt;
}

std::optional<std::string> use_memory(bool (*goes_on)())
{
    std::vector<std::uint64_t> words(kMemoryBytes / sizeof(std::uint64_t), 0);
    std::uint64_t x = 1;
    while (goes_on())
    {
        for (int i = 0; i < 100'000; ++i)
        {
            x = next(x);
            ++words[x % words.size()];
        }
        if (auto fault = map_and_touch())
        {
            return fault;
        }
    }
    return std::nullopt;
}

/// Writes or reads the whole file once. Returns true on success.
template <typename Transfer>
bool transfer_all(int file, std::vector<char>& block, Transfer transfer)
{
    bool went_well = lseek(file, 0, SEEK_SET) == 0;
    for (std::size_t done = 0; went_well && done < kDiskBytes; done += block.size())
    {
        went_well =
            transfer(file, block.data(), block.size()) == static_cast<ssize_t>(block.size());
    }
    return went_well;
}

std::optional<std::string> use_disk(bool (*goes_on)())
{
    std::string path = (std::filesystem::temp_directory_path() / "hrtc-load-XXXXXX").string();
    const int file = mkstemp(path.data());
    if (file < 0)
    {
        return path + ": can't be created: " + error_text(errno);
    }
    unlink(path.c_str()); // The file is removed when it is closed.
    std::vector<char> block(kBlockBytes, 'x');
    bool went_well = true;
    while (went_well && goes_on())
    {
        went_well =
            transfer_all(file, block, write) && fsync(file) == 0 && transfer_all(file, block, read);
    }
    const std::string reason = error_text(errno);
    close(file);
    return went_well ? std::nullopt
                     : std::optional(path + ": can't be written and read: " + reason);
}

/// True if the writer of standard input is still open. Drops the bytes that arrive.
bool stdin_is_open()
{
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, 0) <= 0)
    {
        return true;
    }
    std::array<char, 64> bytes{};
    return read(STDIN_FILENO, bytes.data(), bytes.size()) > 0;
}

} // namespace

std::optional<LoadKind> parse_load(std::string_view name) noexcept
{
    const auto* const found = std::ranges::find(
        kLoadNames, name, [](const char* each) { return std::string_view(each); });
    return found == kLoadNames.end() ? std::nullopt
                                     : std::optional(LoadKind(found - kLoadNames.begin()));
}

std::optional<std::string> work(LoadKind kind, bool (*goes_on)())
{
    switch (kind)
    {
    case LoadKind::cpu:
        calculate(goes_on);
        return std::nullopt;
    case LoadKind::memory:
        return use_memory(goes_on);
    case LoadKind::disk:
        return use_disk(goes_on);
    }
    return std::nullopt;
}

Result<Load, std::string> Load::start(std::span<const LoadKind> kinds, const std::string& program)
{
    Load load;
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0)
    {
        return "the load can't be started: " + error_text(errno);
    }
    load.their_end_ = ends[0];
    load.lifeline_ = ends[1];
    // Otherwise the workers would keep the pipe open.
    fcntl(load.lifeline_, F_SETFD, FD_CLOEXEC);
    fcntl(load.their_end_, F_SETFD, FD_CLOEXEC);
    const auto processors = std::max(sysconf(_SC_NPROCESSORS_ONLN), 1L);
    for (const LoadKind kind : kinds)
    {
        for (long i = 0; i < (kind == LoadKind::disk ? 1L : processors); ++i)
        {
            if (const auto fault = load.start_one(kind, program))
            {
                return *fault;
            }
        }
    }
    return load;
}

std::optional<std::string> Load::start_one(LoadKind kind, const std::string& program)
{
    std::string name = kLoadNames[static_cast<std::size_t>(kind)];
    std::string path = program;
    std::string command = "load";
    std::array<char*, 4> arguments{path.data(), command.data(), name.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, their_end_, STDIN_FILENO);
    pid_t process = 0;
    const int failed =
        posix_spawn(&process, path.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0)
    {
        return "the load '" + name + "' can't be started: " + error_text(failed);
    }
    workers_.push_back({kind, process});
    return std::nullopt;
}

Load::Load(Load&& other) noexcept
    : workers_(std::exchange(other.workers_, {}))
    , lifeline_(std::exchange(other.lifeline_, -1))
    , their_end_(std::exchange(other.their_end_, -1))
{
}

Load::~Load()
{
    if (lifeline_ >= 0)
    {
        close(lifeline_);
        close(their_end_);
    }
    for (const Worker& worker : workers_)
    {
        waitpid(worker.process, nullptr, 0);
    }
}

std::optional<LoadKind> Load::ended()
{
    const auto worker = std::ranges::find_if(
        workers_, [](const Worker& each) { return waitpid(each.process, nullptr, WNOHANG) != 0; });
    if (worker == workers_.end())
    {
        return std::nullopt;
    }
    const LoadKind kind = worker->kind;
    workers_.erase(worker);
    return kind;
}

int run_load(int argc, char** argv)
{
    CommandLine line("hrtc load", "Keeps one processor of this machine busy with one kind of work "
                                  "until standard input ends, to test a haptic loop under load.");
    std::string name;
    line.add_option("KIND", name, "Kind of work: cpu, memory or disk")
        .required()
        .one_of({kLoadNames.begin(), kLoadNames.end()});
    if (const std::optional<int> code = line.parse(argc, argv))
    {
        return *code;
    }
    linux_extras::let_calling_thread_use_all(); // Includes the processor that hrtc itself avoids.
    if (const auto fault = work(parse_load(name).value(), stdin_is_open))
    {
        return line.fail(*fault);
    }
    return kExitDone;
}

} // namespace tactus::hrtc
