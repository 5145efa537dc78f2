// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <stdexcept>
#include <string>

namespace tactus
{

namespace
{

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
