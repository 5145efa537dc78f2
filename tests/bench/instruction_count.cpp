// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/instruction_count.hpp"

#include "rt_core/base/realtime.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace tactus::bench
{

namespace
{

/// Runs a program from the path without its output. Returns its exit code; empty if it cannot be
/// run.
std::optional<int> run_unheard(std::vector<std::string> words)
{
    std::vector<char*> arguments;
    for (std::string& word : words)
    {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    {
        posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
    }
    pid_t child = 0;
    const int error =
        posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (error != 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status))
    {
        return std::nullopt;
    }
    return WEXITSTATUS(status);
}

/// Totals that callgrind wrote for each counted part, the rest of the run last.
std::vector<std::uint64_t> totals_in(const std::filesystem::path& file)
{
    static const std::string kTotal = "totals: ";
    std::vector<std::uint64_t> totals;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);)
    {
        if (line.starts_with(kTotal))
        {
            totals.push_back(std::stoull(line.substr(kTotal.size())));
        }
    }
    return totals;
}

// Callgrind finds functions by name. These must be called although they do nothing, and must
// differ, or the compiler merges them.
[[gnu::noinline]] void frame_begins() noexcept
{
    asm volatile("" : : "i"(1));
}

[[gnu::noinline]] void stage_ended() noexcept
{
    asm volatile("" : : "i"(2));
}

// Calls the empty mark, then the given one.
TACTUS_TRUSTED_BEGIN
void end_stage(void* context, Stage stage) noexcept TACTUS_NONBLOCKING
{
    stage_ended();
    (*static_cast<const StageMark*>(context))(stage);
}
TACTUS_TRUSTED_END

/// Runs the case under callgrind with additional options. Returns the counts by part.
std::vector<std::uint64_t> run_counted(const CaseContext& context,
                                       const std::vector<std::string>& how)
{
    const BenchOptions& options = context.options;
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "callgrind.out";
    std::vector<std::string> words{"valgrind", "--tool=callgrind",
                                   "--callgrind-out-file=" + file.string()};
    words.insert(words.end(), how.begin(), how.end());
    words.insert(words.end(), {std::filesystem::read_symlink("/proc/self/exe").string(),
                               context.suite, "--only", context.name, "--count"});
    const auto add = [&words](const char* option, const std::string& value) {
        words.insert(words.end(), {option, value});
    };
    if (!options.cache.empty())
    {
        add("--cache", options.cache.string());
    }
    if (options.frames)
    {
        add("--frames", std::to_string(*options.frames));
    }
    if (options.quick)
    {
        words.emplace_back("--quick");
    }
    const std::optional<int> code = run_unheard(words);
    std::vector<std::uint64_t> totals = code == 0 ? totals_in(file) : std::vector<std::uint64_t>{};
    if (totals.empty())
    {
        throw Failure(code ? fmt::format("--instructions: valgrind ended with {}", *code)
                           : "--instructions: valgrind can't be run");
    }
    return totals;
}

} // namespace

[[gnu::noinline]] FrameOutput counted_step(test::FrameRig& rig, std::span<const ToolState> tools,
                                           const Budgets& budgets, StageMark mark)
{
    frame_begins();
    return rig.step_without_delivery(tools, budgets, {&end_stage, &mark});
}

[[gnu::noinline]] FrameOutput counted_step(test::FrameRig& rig, const std::vector<Vec3>& goals_m,
                                           const Budgets& budgets, StageMark mark)
{
    frame_begins();
    return rig.step_without_delivery(goals_m, budgets, {&end_stage, &mark});
}

std::optional<std::uint64_t> count_instructions(const CaseContext& context)
{
    if (!context.options.instructions || context.options.count)
    {
        return std::optional<std::uint64_t>{};
    }
    const auto counted = run_counted(context, {"--toggle-collect=tactus::bench::counted_step(*"});
    return std::optional(counted.front());
}

std::vector<StageCounts> count_stages(const CaseContext& context)
{
    if (!context.options.instructions || context.options.count)
    {
        return std::vector<StageCounts>{};
    }
    // Each stage is a part, and the time after the last one too.
    const auto parts =
        run_counted(context, {"--zero-before=tactus::bench::(anonymous namespace)::frame_begins(*",
                              "--dump-before=tactus::bench::(anonymous namespace)::stage_ended(*",
                              "--combine-dumps=yes", "--dump-line=no"});
    std::vector<StageCounts> frames((parts.size() - 1) / kStages);
    for (std::size_t i = 0; i < frames.size() * kStages; ++i)
    {
        frames[i / kStages][i % kStages] = parts[i];
    }
    return frames;
}

} // namespace tactus::bench
