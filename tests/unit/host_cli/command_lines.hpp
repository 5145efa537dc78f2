// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/program/command_line.hpp"
#include "transport/base/printable.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// Reactions of programs to command lines, without starting them.
namespace tactus::test
{

/// Parser of a program's command line like its main(); returns the exit code.
using Parse = std::function<int(int argc, char** argv)>;

inline std::string replaced(std::string text, const std::string& part, const std::string& by)
{
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += by.size())
    {
        text.replace(at, part.size(), by);
    }
    return text;
}

/// Words separated by blanks: '' is an empty one; \s, \n and \e stand for characters that a word
/// cannot contain.
inline std::vector<std::string> words_of(const std::string& line)
{
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
    {
        for (const auto& [part, by] : {std::pair("''", ""), std::pair("\\s", " "),
                                       std::pair("\\n", "\n"), std::pair("\\e", "\x1b")})
        {
            word = replaced(std::move(word), part, by);
        }
        words.push_back(word);
    }
    return words;
}

/// Expects that the program exits with this code. The first word is its name.
inline void expect_left(const Parse& parse, std::vector<std::string> words, int code)
{
    std::vector<char*> arguments;
    for (std::string& word : words)
    {
        arguments.push_back(word.data());
    }
    EXPECT_EQ(parse(static_cast<int>(arguments.size()), arguments.data()), code);
}

/// Output on stderr before the exit.
inline std::string refusal_of(const Parse& parse, const std::vector<std::string>& words,
                              int code = kExitUsage)
{
    testing::internal::CaptureStderr();
    expect_left(parse, words, code);
    return testing::internal::GetCapturedStderr();
}

/// Output on stdout before a successful exit.
inline std::string shown_by(const Parse& parse, const std::string& line)
{
    testing::internal::CaptureStdout();
    expect_left(parse, words_of(line), kExitDone);
    return testing::internal::GetCapturedStdout();
}

/// Checks each line of a table: CODE | COMMAND | text on stderr | VALUES. Each value replaces {} in
/// both. Returns the number of commands.
inline std::size_t expect_refusals(const Parse& parse, const std::string& table)
{
    std::size_t commands = 0;
    std::ifstream file(table);
    for (std::string line; std::getline(file, line);)
    {
        if (line.empty() || line.front() == '#')
        {
            continue;
        }
        SCOPED_TRACE(line);
        std::vector<std::string> fields{line};
        for (std::size_t bar = 0; (bar = fields.back().find(" | ")) != std::string::npos;)
        {
            std::string rest = fields.back().substr(bar + 3);
            fields.back().resize(bar);
            fields.push_back(std::move(rest));
        }
        fields.resize(std::max<std::size_t>(fields.size(), 4), "''");
        for (const std::string& value : words_of(fields[3]))
        {
            std::vector<std::string> words = words_of(fields[1]);
            for (std::string& word : words)
            {
                word = replaced(std::move(word), "{}", value);
            }
            EXPECT_EQ(refusal_of(parse, words, std::stoi(fields[0])),
                      replaced(fields[2], "{}", printable(value)) + "\n")
                << printable(value);
            ++commands;
        }
    }
    return commands;
}

} // namespace tactus::test
