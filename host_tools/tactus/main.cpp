// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Program tactus: the other programs under one name, and the shortest way from a mesh to its
/// touch.

#include "host_tools/tactus/programs.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/suggestions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::tactus_program
{

namespace
{

/// Command of another program, which gets all further arguments.
struct Command
{
    std::string_view name;
    std::string_view program;
    std::string_view first; ///< Argument that precedes the others; empty: none.
    std::string_view summary;
};

constexpr std::array kCommands{
    Command{"build", "spm_build", "", "makes models of meshes and scenes"},
    Command{"inspect", "spm_inspect", "", "checks and shows a model"},
    Command{"serve", "spm_publish", "", "serves models to controllers over DDS"},
    Command{"view", "spm_view", "", "shows runs in a browser"},
    Command{"run", "hrtc", "", "touches models in real time"},
    Command{"doctor", "hrtc", "doctor", "checks whether this machine is fit for the haptic loop"},
};

std::string describe_commands()
{
    std::string text = "Commands:\n  tactus touch     builds, touches and shows a mesh";
    for (const Command& each : kCommands)
    {
        text += fmt::format("\n  tactus {:<10}{}: {}{}{}", each.name, each.summary, each.program,
                            each.first.empty() ? "" : " ", each.first);
    }
    return text + "\nEach command has its own --help.";
}

/// Message that no command is called so, with the most similar one.
std::string no_command(std::string_view word)
{
    std::vector<std::string_view> names{"touch"};
    std::ranges::transform(kCommands, std::back_inserter(names), &Command::name);
    const std::string nearest = nearest_word(word, names);
    return fmt::format("'{}': no command is called so; {}", printable(word),
                       nearest.empty() ? "see --help" : nearest + "?");
}

int run(int argc, char** argv)
{
    CommandLine line("tactus", "Runs the programs of Tactus under one name.");
    line.add_version("tactus " TACTUS_VERSION);
    line.set_footer(describe_commands());
    const std::string_view word = argc > 1 ? argv[1] : "";
    char help[] = "--help";
    if (word == "help")
    {
        argv[1] = help;
    }
    else if (word == "touch")
    {
        return touch(argc - 1, argv + 1);
    }
    else if (const auto* const found = std::ranges::find(kCommands, word, &Command::name);
             found != kCommands.end())
    {
        std::vector<std::string> arguments(argv + 2, argv + argc);
        if (!found->first.empty())
        {
            arguments.emplace(arguments.begin(), found->first);
        }
        return line.fail(become(found->program, arguments).text);
    }
    else if (!word.empty() && !word.starts_with('-'))
    {
        return line.fail(no_command(word), kExitUsage);
    }
    const auto code = line.parse(argc, argv);
    return code ? *code : line.fail("a command is missing; see --help", kExitUsage);
}

} // namespace

} // namespace tactus::tactus_program

int main(int argc, char** argv)
{
    return tactus::run_program("tactus", "",
                               [&] { return tactus::tactus_program::run(argc, argv); });
}
