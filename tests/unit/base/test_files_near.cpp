// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/temporary_folder.hpp"
#include "transport/base/files_near.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace tactus
{

namespace
{

TEST(FilesNear, is_the_file_with_the_ending_that_was_left_out)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "plate.spm") << "x";
    const std::string path = (folder.path() / "plate").string();
    EXPECT_EQ(files_near(path, ".spm"), "; " + path + ".spm exists");
}

TEST(FilesNear, lists_what_else_the_folder_has)
{
    const test::TemporaryFolder folder;
    const std::string path = folder.path().string();
    EXPECT_EQ(files_near(path + "/ball.spm", ".spm"), "; " + path + " has no .spm");
    for (const char* name : {"d.spm", "a.spm", "c.spm", "b.spm", "a.obj", ".spm"})
    {
        std::ofstream(folder.path() / name) << "x";
    }
    EXPECT_EQ(files_near(path + "/ball.spm", ".spm"),
              "; " + path + " has a.spm, b.spm, c.spm, d.spm");
    for (const char* name : {"e.spm", "f.spm", "g\n.spm"})
    {
        std::ofstream(folder.path() / name) << "x";
    }
    EXPECT_EQ(files_in(path, ".spm"), "a.spm, b.spm, c.spm, d.spm, e.spm and 2 more");
    EXPECT_EQ(files_near(path + "/nowhere/ball.spm", ".spm"),
              "; no such folder: " + path + "/nowhere");
}

} // namespace

} // namespace tactus
