// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/instruction_count.hpp"

#include "tests/shared/temporary_folder.hpp"

#include <fmt/format.h>

#include <array>
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

/// Runs a program of the path, unheard. Its exit code, or none when it can't be run.
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

/// What callgrind wrote of all that it counted; 0 where it wrote nothing.
std::uint64_t total_in(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);)
    {
        for (const char* const name : {"summary: ", "totals: "})
        {
            if (line.starts_with(name))
            {
                return std::stoull(line.substr(std::string(name).size()));
            }
        }
    }
    return 0;
}

} // namespace

[[gnu::noinline]] FrameOutput counted_step(test::FrameRig& rig, const std::vector<Vec3>& goals_m,
                                           const Budgets& budgets, StageMark mark)
{
    return rig.step_without_delivery(goals_m, budgets, mark);
}

Result<std::optional<std::uint64_t>, SceneError> count_instructions(const CaseContext& context)
{
    const BenchOptions& options = context.options;
    if (!options.instructions || options.count)
    {
        return std::optional<std::uint64_t>{};
    }
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "callgrind.out";
    std::vector<std::string> words{"valgrind",
                                   "--tool=callgrind",
                                   "--toggle-collect=tactus::bench::counted_step(*",
                                   "--callgrind-out-file=" + file.string(),
                                   std::filesystem::read_symlink("/proc/self/exe").string(),
                                   context.suite,
                                   "--only",
                                   context.name,
                                   "--count"};
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
    const std::uint64_t counted = code == 0 ? total_in(file) : 0;
    if (counted == 0)
    {
        return SceneError{code ? fmt::format("--instructions: valgrind ended with {}", *code)
                               : "--instructions: valgrind can't be run"};
    }
    return std::optional(counted);
}

} // namespace tactus::bench
