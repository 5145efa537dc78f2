// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/site.hpp"
#include "host_tools/spm_build/options.hpp"
#include "host_tools/spm_inspect/options.hpp"
#include "host_tools/spm_publish/options.hpp"
#include "host_tools/spm_view/options.hpp"
#include "platform/program/command_line.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/unit/host_cli/command_lines.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tactus
{
namespace
{

template <typename Options>
int code_of(const std::variant<Options, int>& parsed)
{
    const int* code = std::get_if<int>(&parsed);
    return code == nullptr ? kExitDone : *code;
}

/// Parses like the main() of the program named by the first word.
int parse_server_options(int argc, char** argv)
{
    const std::string_view name = argv[0];
    CommandLine line(argv[0], "");
    return name == "spm_build"     ? code_of(spm_build::parse_options(line, argc, argv))
           : name == "spm_inspect" ? code_of(spm_inspect::parse_options(line, argc, argv))
           : name == "tactus-keys" ? code_of(keys::parse_options(line, argc, argv))
           : name == "spm_publish" ? code_of(spm_publish::parse_options(line, argc, argv))
                                   : code_of(view::parse_options(line, argc, argv));
}

TEST(ServerOptions, are_refused_in_one_line)
{
    EXPECT_GE(test::expect_refusals(parse_server_options, TACTUS_WRONG_USAGES), 100U);
}

/// One file for all programs of a machine.
TEST(ServerOptions, of_a_site_are_read_from_a_file)
{
    const test::TemporaryFolder folder("site");
    const auto read = [&](const char* program, const char* text)
    {
        std::string words[] = {program, "ball.spm", "--config",
                               folder.write("site.toml", text).string()};
        std::vector<char*> arguments;
        for (std::string& word : words)
        {
            arguments.push_back(word.data());
        }
        CommandLine line(program, "");
        NetworkSecurity security;
        if (std::string_view(program) == "spm_publish")
        {
            const auto parsed = spm_publish::parse_options(line, 4, arguments.data());
            EXPECT_TRUE(std::holds_alternative<spm_publish::Options>(parsed));
            security = std::get<spm_publish::Options>(parsed).security;
        }
        else
        {
            const auto parsed = view::parse_options(line, 4, arguments.data());
            EXPECT_TRUE(std::holds_alternative<view::Options>(parsed));
            security = std::get<view::Options>(parsed).security;
        }
        return security;
    };
    for (const char* program : {"spm_publish", "spm_view"})
    {
        const NetworkSecurity all =
            read(program, "domain = 7\nsecurity = \"/keys\"\nrequire-security = true\n");
        EXPECT_EQ(all.keys, "/keys");
        EXPECT_TRUE(all.is_required);
        EXPECT_FALSE(read(program, "domain = 7\n").is_required);
        EXPECT_TRUE(read(program, "require-security = false\nplain = true\n").is_plain);
    }
}

TEST(ServerOptions, are_explained_behind_the_name_of_the_program)
{
    for (const auto& [name, option] :
         {std::pair("spm_build", "--unit"), std::pair("spm_inspect", "--extract"),
          std::pair("spm_publish", "--domain"), std::pair("spm_view", "--replay"),
          std::pair("tactus-keys", "--revoke")})
    {
        const std::string program = name;
        const std::string version = test::shown_by(parse_server_options, program + " --version");
        EXPECT_TRUE(version.starts_with(program + " ")) << version;
        const std::string help = test::shown_by(parse_server_options, program + " --help");
        EXPECT_NE(help.find(option), std::string::npos) << help;
    }
}

} // namespace
} // namespace tactus
