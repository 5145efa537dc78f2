// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <sys/stat.h>
#include <vector>

namespace tactus
{
namespace
{

using Words = std::vector<std::string>;

/// One option of each kind.
struct Form
{
    std::string file;
    int count{3};
    std::uint32_t domain{0};
    std::int64_t rate_hz{1'000};
    double share{0.5};
    std::string unit{"mm"};
    std::filesystem::path folder;
    std::optional<int> cpu;
    std::optional<std::uint32_t> faces;
    std::optional<double> seconds;
    std::optional<std::string> motion;
    Words models;
    Words names;
    Words loads;
    bool json{false};
    bool prints{false};

    CommandLine line{"try", "Tries options."};

    Form()
    {
        line.add_version("try 7");
        line.add_option("FILE", file, "To read").required();
        line.add_option("-n,--count", count, "How many").integer_between(-2, 9).show_default();
        line.add_option("--domain", domain, "Where")
            .integer_between(std::uint32_t{0}, std::uint32_t{232});
        line.add_option("--rate", rate_hz, "How often")
            .integer_between(std::int64_t{1}, std::int64_t{9'000'000'000});
        line.add_option("--share", share, "How much").number_between(0.0, 1.0).show_default();
        line.add_option("--unit", unit, "Of length").one_of({"mm", "m"});
        line.add_option("--folder", folder, "To keep it").existing_directory();
        const auto processor = line.add_option("--cpu", cpu, "Which");
        line.add_option("--faces", faces, "Of the mesh").needs(processor);
        line.add_option("--seconds", seconds, "How long").excludes(processor);
        line.add_option("--motion", motion, "Of the hand")
            .check([](const std::string& text) { return text == "tap" ? "" : "no " + text; },
                   "tap");
        line.begin_task("Where", "try in.ply --model a");
        line.add_option("--model", models, "To touch").repeatable();
        line.add_option("--name", names, "Of the models").repeatable_with_more();
        line.add_option("--load", loads, "Beside").separated_by(',');
        line.add_flag("--json", json, "As JSON");
        line.add_option_file("--config", "Options");
        line.add_former_name("amount", "count");
        line.add_flag("--print", prints, "Show them").not_in_file();
        line.set_footer("The end.");
    }

    std::optional<int> parse(Words words)
    {
        words.insert(words.begin(), "try");
        std::vector<char*> arguments;
        for (std::string& word : words)
        {
            arguments.push_back(word.data());
        }
        return line.parse(static_cast<int>(arguments.size()), arguments.data());
    }
};

/// Line on stderr after wrong usage.
std::string refusal_of(const Words& words)
{
    Form form;
    testing::internal::CaptureStderr();
    EXPECT_EQ(form.parse(words), kExitUsage);
    return testing::internal::GetCapturedStderr();
}

/// Output on stdout before a successful exit.
std::string shown_by(const Words& words)
{
    Form form;
    testing::internal::CaptureStdout();
    EXPECT_EQ(form.parse(words), kExitDone);
    return testing::internal::GetCapturedStdout();
}

TEST(CommandLine, reads_values_of_each_type)
{
    Form form;
    ASSERT_EQ(form.parse({"in.ply",     "-n",      "-2",     "--domain",  "232", "--rate",
                          "9000000000", "--share", "0.25",   "--unit",    "m",   "--folder",
                          "/",          "--cpu",   "0",      "--faces",   "7",   "--motion",
                          "tap",        "--json",  "--load", "cpu,memory"}),
              std::nullopt);
    EXPECT_EQ(form.file, "in.ply");
    EXPECT_EQ(form.count, -2);
    EXPECT_EQ(form.domain, 232U);
    EXPECT_EQ(form.rate_hz, 9'000'000'000);
    EXPECT_EQ(form.share, 0.25);
    EXPECT_EQ(form.unit, "m");
    EXPECT_EQ(form.folder, "/");
    EXPECT_EQ(form.cpu, 0);
    EXPECT_EQ(form.faces, 7U);
    EXPECT_EQ(form.seconds, std::nullopt);
    EXPECT_EQ(form.motion, "tap");
    EXPECT_EQ(form.loads, (Words{"cpu", "memory"}));
    EXPECT_TRUE(form.json);
    EXPECT_EQ(form.line.given(),
              (Words{"FILE", "--count", "--domain", "--rate", "--share", "--unit", "--folder",
                     "--cpu", "--faces", "--motion", "--load", "--json"}));
    EXPECT_TRUE(form.line.is_given("-n"));
    EXPECT_FALSE(form.line.is_given("--seconds"));
    EXPECT_FALSE(form.line.is_given("--no-such-option"));
}

TEST(CommandLine, a_repeatable_option_leaves_the_next_word_alone_unless_it_may_take_more)
{
    Form form;
    ASSERT_EQ(form.parse({"--model", "a", "in.ply", "--model", "b", "--name", "c", "d"}),
              std::nullopt);
    EXPECT_EQ(form.file, "in.ply");
    EXPECT_EQ(form.models, (Words{"a", "b"}));
    EXPECT_EQ(form.names, (Words{"c", "d"}));
}

TEST(CommandLine, refuses_wrong_usage_in_one_line_that_names_the_option)
{
    EXPECT_EQ(refusal_of({}), "try: FILE is required; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--fast"}), "try: --fast: no option is called so; see --help\n");
    EXPECT_EQ(refusal_of({"f", "m", "--seconsd=3"}),
              "try: --seconsd: no option is called so; --seconds?\n");
    EXPECT_EQ(refusal_of({"f", "m"}), "try: 'm': nothing takes this word; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--rate", "--share", "1"}),
              "try: --rate: a value is missing; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--rate"}), "try: --rate: a value is missing; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--rate", "1", "--rate", "2"}),
              "try: --rate: is given twice; see --help\n");
    EXPECT_EQ(refusal_of({"f", "-n", "10"}),
              "try: --count: '10' is not a whole number in -2 .. 9; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--domain", "-1"}),
              "try: --domain: '-1' is not a whole number in 0 .. 232; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--share", "nan"}),
              "try: --share: 'nan' is not a number in 0 .. 1; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--unit", "in"}), "try: --unit: 'in' is not mm or m; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--folder", "/none"}),
              "try: --folder: Directory does not exist: /none; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--faces", "1"}), "try: --faces requires --cpu; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--seconds", "1", "--cpu", "1"}),
              "try: --cpu excludes --seconds; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--motion", "a\nb"}), "try: --motion: no a b; see --help\n");
}

TEST(CommandLine, shows_its_version_and_how_it_is_used)
{
    EXPECT_EQ(shown_by({"--version"}), "try 7\n");
    const std::string help = shown_by({"--help"});
    for (const char* part :
         {"Tries options.\nUsage: try [OPTIONS] FILE\n", "-n,--count INT:-2 .. 9 ",
          "How many [default: 3]\n", "--domain UINT:0 .. 232 ", "--share FLOAT:0 .. 1 ",
          "How much [default: 0.5]\n", "--unit TEXT:{mm,m} ", "--motion TEXT:tap ", "--name TEXT ",
          "\nThe end.\n",
          "\nWhere, as in  try in.ply --model a:\n  --model TEXT                To touch\n"})
    {
        EXPECT_NE(help.find(part), std::string::npos) << part << "\n" << help;
    }
}

TEST(CommandLine, reads_a_file_of_options_behind_the_line)
{
    const test::TemporaryFolder folder("command-line");
    const std::string path = folder.path() / "options.toml";
    const auto write = [&](const char* text) { std::ofstream(path) << text; };
    write("count = 5\nshare = 0.125\nmodel = [\"a\", \"b\"]\njson = true\n");
    Form form;
    ASSERT_EQ(form.parse({"f", "--config", path, "--share", "1"}), std::nullopt);
    EXPECT_EQ(form.count, 5);
    EXPECT_EQ(form.share, 1.0);
    EXPECT_EQ(form.models, (Words{"a", "b"}));
    EXPECT_TRUE(form.json);
    const std::string text = form.line.option_file_text();
    EXPECT_NE(text.find("\n# How many\ncount=5\n"), std::string::npos) << text;
    EXPECT_EQ(text.find("\nprint="), std::string::npos) << text;

    const auto refusal_behind_the_path = [&]
    {
        const std::string said = refusal_of({"f", "--config", path});
        const std::string before = "try: --config: " + path;
        EXPECT_EQ(said.substr(0, before.size()), before);
        return said.substr(std::min(before.size(), said.size()));
    };
    write("fast = 1\n");
    EXPECT_EQ(refusal_behind_the_path(), ":1: no option is called 'fast'; see --help\n");
    write("# Mine.\nshare = 1\n  cuont = 1\n");
    EXPECT_EQ(refusal_behind_the_path(), ":3: no option is called 'cuont'; 'count'?\n");
    write("amount = 1\n");
    EXPECT_EQ(refusal_behind_the_path(), ":1: 'amount' is an older version's name; 'count'?\n");
    EXPECT_EQ(refusal_of({"f", "--amount=1"}),
              "try: --amount: an older version's name; --count?\n");
    write("\n[loop]\ncount = 1\n");
    EXPECT_EQ(refusal_behind_the_path(), ":2: begins a section; there are none\n");
    write("share = 1\n count = x\n");
    EXPECT_EQ(refusal_of({"f", "--config", path}),
              "try: " + path + ":2: --count: '...' is not a whole number in -2 .. 9; see --help\n");
    EXPECT_EQ(refusal_of({"f", "--config", path, "--count=y"}),
              "try: --count: 'y' is not a whole number in -2 .. 9; see --help\n");
    write("print = true\n");
    EXPECT_NE(refusal_of({"f", "--config", path}).find("not allowed in a configuration file"),
              std::string::npos);
}

TEST(CommandLine, reads_a_regular_file_of_options_of_one_mebibyte_at_most)
{
    const test::TemporaryFolder folder("command-line");
    const std::string path = folder.path() / "options.toml";
    const auto refusal = [](const std::string& file)
    {
        Form form;
        testing::internal::CaptureStderr();
        EXPECT_EQ(form.parse({"f", "--config", file}), kExitFailed);
        return testing::internal::GetCapturedStderr();
    };
    const std::string comment(1'000, '#');
    std::ofstream file(path);
    for (std::size_t bytes = 0; bytes + comment.size() < (1U << 20); bytes += comment.size() + 1)
    {
        file << comment << '\n';
    }
    file.flush();
    Form form;
    EXPECT_EQ(form.parse({"f", "--config", path}), std::nullopt);
    file << comment << '\n';
    file.close();
    const std::string size = std::to_string(std::filesystem::file_size(path));
    EXPECT_EQ(refusal(path),
              "try: --config: " + path + ": has " + size + " bytes; at most 1048576 are read\n");
    const std::string pipe = folder.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    for (const std::string& endless : {pipe, std::string("/dev/zero")})
    {
        EXPECT_EQ(refusal(endless), "try: --config: " + endless + ": is not a regular file\n");
    }
    std::ofstream(path, std::ios::trunc).close();
    EXPECT_EQ(refusal(path), "try: --config: " + path + ": is empty\n");
}

TEST(CommandLine, fails_in_one_line_behind_the_name_of_the_program)
{
    testing::internal::CaptureStderr();
    EXPECT_EQ(CommandLine("try", "").fail("no\tfile"), kExitFailed);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "try: no?file\n");
}

/// Output on stderr; checks the exit code.
std::string said_by(const std::string& hint, const std::function<int()>& body, int code)
{
    testing::internal::CaptureStderr();
    EXPECT_EQ(run_program("spm_try", hint, body), code);
    return testing::internal::GetCapturedStderr();
}

TEST(RunProgram, leaves_with_the_code_of_its_body_and_says_nothing)
{
    EXPECT_EQ(said_by(
                  "", [] { return kExitDone; }, kExitDone),
              "");
    EXPECT_EQ(said_by(
                  "", [] { return kExitUsage; }, kExitUsage),
              "");
}

TEST(RunProgram, makes_one_line_of_what_is_thrown_and_fails)
{
    const auto body = []() -> int { throw std::runtime_error("no\nfile"); };
    EXPECT_EQ(said_by("hint", body, kExitFailed), "spm_try: no?file\n");
}

TEST(RunProgram, says_how_much_memory_is_needed_when_it_runs_out)
{
    const auto body = []() -> int { throw std::bad_alloc(); };
    EXPECT_EQ(said_by("about 9 bytes a face are needed", body, kExitFailed),
              "spm_try: not enough memory; about 9 bytes a face are needed\n");
    EXPECT_EQ(said_by("", body, kExitFailed), "spm_try: std::bad_alloc\n");
}

} // namespace
} // namespace tactus
