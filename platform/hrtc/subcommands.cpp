// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/subcommands.hpp"

#include "platform/diagnose/commands.hpp"
#include "platform/diagnose/load.hpp"
#include "platform/readers/file_readers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace tactus::hrtc
{

namespace
{

constexpr std::array kSubcommands{
    Subcommand{"doctor", "checks whether this machine is fit for the haptic loop", run_doctor},
    Subcommand{"deadline-test", "reports the cause of each missed deadline, alone and beside load",
               [](int argc, char** argv) { return run_deadline_test(argc, argv, program_form()); }},
    Subcommand{"load", "keeps this machine busy", run_load},
};

} // namespace

std::span<const Subcommand> subcommands() noexcept
{
    return kSubcommands;
}

const Subcommand* find_subcommand(int argc, char** argv) noexcept
{
    std::string_view word = argc > 1 ? argv[1] : "";
    word.remove_prefix(word.starts_with("--") ? 2 : 0); // Also accepts --doctor.
    const auto* const found = std::ranges::find(
        kSubcommands, word, [](const Subcommand& each) { return std::string_view(each.name); });
    return found == kSubcommands.end() ? nullptr : found;
}

std::string subcommand_names()
{
    std::string text;
    for (const Subcommand& each : subcommands())
    {
        text += fmt::format("{}{}", text.empty() ? "" : ", ", each.name);
    }
    return text;
}

std::string describe_subcommands()
{
    std::string text = "Other commands:";
    for (const Subcommand& each : subcommands())
    {
        text += fmt::format("\n  {:<26}{}", fmt::format("hrtc {}", each.name), each.summary);
    }
    return text + "\nEach command has its own --help.";
}

CommandForm program_form()
{
    return {.declare = {},
            .footer = describe_subcommands(),
            .commands = subcommand_names(),
            .readers = file_readers()};
}

} // namespace tactus::hrtc
