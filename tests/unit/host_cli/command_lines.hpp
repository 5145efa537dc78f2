// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/cli/command_line.hpp"
#include "platform/base/printable.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

/// What programs say to command lines, without starting them; tables of what they refuse.
namespace tactus::test
{

/// What reads a program's command line as its main() does, and returns the exit code.
using Parse = std::function<int(int argc, char** argv)>;

/// Words with blanks between, the program's name first, and the whole line on stderr.
struct RefusedLine
{
    std::string words;
    std::string said;
};

/// Values that are refused behind these words, each in the same way: its text takes the place of {}
/// in what is said.
struct RefusedValues
{
    std::string words;
    std::vector<std::string> values;
    std::string said;
};

inline std::vector<std::string> words_of(const std::string& line)
{
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
    {
        words.push_back(word);
    }
    return words;
}

/// Checks that the program leaves with this code.
inline void expect_left(const Parse& parse, std::vector<std::string> words, int code)
{
    std::vector<char*> arguments;
    for (std::string& word : words)
    {
        arguments.push_back(word.data());
    }
    EXPECT_EQ(parse(static_cast<int>(arguments.size()), arguments.data()), code);
}

/// What it says on stderr before it does so.
inline std::string refusal_of(const Parse& parse, const std::vector<std::string>& words,
                              int code = kExitUsage)
{
    testing::internal::CaptureStderr();
    expect_left(parse, words, code);
    return testing::internal::GetCapturedStderr();
}

/// What it says on stdout before it leaves with success.
inline std::string shown_by(const Parse& parse, const std::string& line)
{
    testing::internal::CaptureStdout();
    expect_left(parse, words_of(line), kExitDone);
    return testing::internal::GetCapturedStdout();
}

inline void expect_refused(const Parse& parse, std::span<const RefusedLine> lines,
                           int code = kExitUsage)
{
    for (const auto& [words, said] : lines)
    {
        SCOPED_TRACE(words);
        EXPECT_EQ(refusal_of(parse, words_of(words), code), said + "\n");
    }
}

inline void expect_refused(const Parse& parse, std::span<const RefusedValues> options)
{
    for (const auto& [line, values, said] : options)
    {
        for (const std::string& value : values)
        {
            SCOPED_TRACE(line + " '" + printable(value) + "'");
            std::vector<std::string> words = words_of(line);
            words.push_back(value);
            std::string wanted = said;
            if (const std::size_t hole = wanted.find("{}"); hole != std::string::npos)
            {
                wanted.replace(hole, 2, printable(value));
            }
            EXPECT_EQ(refusal_of(parse, words, kExitUsage), wanted + "\n");
        }
    }
}

} // namespace tactus::test
