// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/site.hpp"
#include "host_tools/spm_build/options.hpp"
#include "host_tools/spm_inspect/options.hpp"
#include "host_tools/spm_publish/options.hpp"
#include "host_tools/spm_view/options.hpp"
#include "platform/program/run_program.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/unit/host_cli/command_lines.hpp"

#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>
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

/// Exit code of a separate process, or the negative number of the signal that ended it.
template <typename Work>
int code_of(const Work& work)
{
    const pid_t process = ::fork();
    if (process == 0)
    {
        ::_exit(work());
    }
    int status = 0;
    EXPECT_EQ(::waitpid(process, &status, 0), process);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

/// Exit code; 1 if the signal requested the end.
int code_after(int signal)
{
    return code_of(
        [signal]
        {
            stop_on_signals();
            ::raise(signal);
            return is_stop_requested() ? 1 : 0;
        });
}

TEST(StopSignals, ask_the_program_to_end)
{
    for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGALRM, SIGUSR1, SIGUSR2})
    {
        EXPECT_EQ(code_after(signal), 1) << signal;
    }
    EXPECT_EQ(code_after(SIGKILL), -SIGKILL);
}

TEST(StopSignals, of_a_reader_that_is_gone_and_of_a_file_that_is_full_do_nothing)
{
    EXPECT_EQ(code_after(SIGPIPE), 0);
    EXPECT_EQ(code_after(SIGXFSZ), 0);
}

TEST(StopSignals, that_nohup_ignores_stay_ignored)
{
    const auto hang_up = []
    {
        std::signal(SIGHUP, SIG_IGN);
        stop_on_signals();
        ::raise(SIGHUP);
        return is_stop_requested() ? 1 : 0;
    };
    EXPECT_EQ(code_of(hang_up), 0);
}

TEST(PrintOut, goes_on_where_nobody_reads)
{
    const auto print = []
    {
        stop_on_signals();
        std::array<int, 2> pipe{};
        if (::pipe(pipe.data()) != 0 || ::dup2(pipe[1], STDOUT_FILENO) < 0)
        {
            return 2;
        }
        ::close(pipe[0]);
        ::close(pipe[1]);
        print_out(std::string(100'000, 'a'));
        ::close(STDOUT_FILENO);
        print_out("a");
        return 0;
    };
    EXPECT_EQ(code_of(print), 0);
}

} // namespace
} // namespace tactus
